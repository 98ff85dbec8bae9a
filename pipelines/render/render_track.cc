// SPDX-License-Identifier: Apache-2.0
#include "pipelines/render/render_track.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/track.h"
#include "pipelines/body_of_track.h"
#include "pipelines/files.h"
#include "pipelines/render/render_sinks.h"
#include "pipelines/video/track_video.h"
#include "render/view/overlay.h"

namespace bodyloom {
namespace {

constexpr int kImagesOfAHeldPose = 120, kCellsOfAHeldPose = 12;  // one turn: 4 s, or a contact sheet

void CheckOptions(const RenderTrackRequest& request) {
  const bool is_npz = request.out.ends_with(".npz");
  if (!is_npz && !request.out.ends_with(".mp4") && !request.out.ends_with(".png")) {
    throw RequestError("--out " + request.out + ": expected a name that ends in .mp4, .png or .npz");
  }
  if (request.what == RenderKind::kTexture && request.texture.empty()) {
    throw RequestError("--what texture needs the image to put on the body: give --texture FILE");
  }
  if (request.what != RenderKind::kTexture && !request.texture.empty()) {
    throw RequestError("--texture is only seen with --what texture, not with --what " + ToString(request.what));
  }
  if (request.what == RenderKind::kError && request.truth.empty()) {
    throw RequestError("--what error needs the track to compare with: give --truth FILE");
  }
  if (request.what != RenderKind::kError && !request.truth.empty()) {
    throw RequestError("--truth is only seen with --what error, not with --what " + ToString(request.what));
  }
  if (!request.video.empty() && (request.view_yaw_deg || request.turntable)) {
    throw RequestError(
        "a video shows the person from its own camera alone: give --video, or --view-yaw and --turntable");
  }
  if (is_npz && !request.video.empty() && request.what != RenderKind::kOverlay &&
      request.what != RenderKind::kTexture) {
    throw RequestError("arrays of " + ToString(request.what) +
                       " hold the surface alone: leave --video out, or write .mp4 or .png");
  }
}

/// Files that are read beside the track, the body and the truth, and those that are written.
void CheckOtherFiles(const RenderTrackRequest& request) {
  RequireReadable(request.video, "video");
  RequireReadable(request.texture, "texture");
  RequireDistinct({request.video, request.texture}, {request.out, request.json});
  RequireWritable(request.out);
  RequireWritable(request.json);
}

std::vector<RenderStep> StepsOf(const RenderTrackRequest& request, int first, int end) {
  const int frames = end - first;
  const int held = request.out.ends_with(".png") ? kCellsOfAHeldPose : kImagesOfAHeldPose;
  const int count = request.turntable && frames == 1 ? held : frames;
  std::vector<RenderStep> steps;
  steps.reserve(static_cast<size_t>(std::max(0, count)));
  for (int i = 0; i < count; ++i) {
    steps.push_back({frames == 1 ? first : first + i, request.turntable ? 360.0 * i / count : 0});
  }
  return steps;
}

double FrameRateOf(const std::vector<RenderStep>& steps, const Track& track) {
  std::vector<double> times;
  for (const RenderStep& step : steps) {
    if (steps.size() > 1 && steps[0].frame == steps[1].frame) {
      break;  // a held pose
    }
    times.push_back(track.motion.timestamps[step.frame]);
  }
  return VideoFrameRate(times);
}

std::vector<std::string> TitleOf(const RenderTrackRequest& request, const Track& track, int first, int end) {
  std::string what = ToString(request.what) + " of " + std::filesystem::path(request.track).filename().string();
  if (!request.video.empty()) {
    what += " over " + std::filesystem::path(request.video).filename().string();
  }
  std::string frames = end - first == 1 ? Concatenate("frame ", first) : Concatenate("frames ", first, " to ", end - 1);
  frames += Concatenate(" of ", track.num_frames(), ":");
  const char* separator = " ";
  for (const FrameStatus status :
       {FrameStatus::kTracked, FrameStatus::kWeak, FrameStatus::kInterpolated, FrameStatus::kLost}) {
    const auto count = std::count(track.frame_status.begin() + first, track.frame_status.begin() + end, status);
    if (count > 0) {
      frames += Concatenate(separator, count, " ", ToString(status));
      separator = ", ";
    }
  }
  return {what, frames};
}

/// Of a request whose options and files are as they must be.
RenderTrackReport RenderChecked(const RenderTrackRequest& request, const BodyModel& body, const Track& given,
                                const Track* given_truth, const PipelineCallbacks& callbacks) {
  const Stopwatch watch;
  Track track = given, truth;
  RequireTrackFitsBody(track, body, request.track);
  const auto [first, end] = FrameRange(request.frames, track.num_frames(), request.track);
  if (given_truth != nullptr) {
    truth = *given_truth;
    RequireTrackFitsBody(truth, body, request.truth);
    truth = TrackInCameras(body, truth);
    if (truth.num_frames() != track.num_frames()) {
      throw std::runtime_error(Concatenate(request.truth, ": ", truth.num_frames(), " frames, expected ",
                                           track.num_frames(), " as ", request.track, " has"));
    }
  }
  std::unique_ptr<TrackVideo> video;
  if (!request.video.empty()) {
    if (track.camera.width <= 0) {  // a track that does not tell was made in the pixels of its video
      const VideoInfo info = VideoReader(request.video, track.playback.turn_deg).info();
      track.camera.width = info.width, track.camera.height = info.height;
    }
    video = std::make_unique<TrackVideo>(request.video, track);
    track = video->Moved(std::move(track));
    if (given_truth != nullptr) truth = video->Moved(std::move(truth));
  }

  FrameRendererOptions options;
  options.kind = request.what;
  options.new_view = request.view_yaw_deg.has_value() || request.turntable;
  options.view_yaw_deg = request.view_yaw_deg.value_or(0);
  options.turntable = request.turntable;
  options.num_threads = ThreadsFor(request.num_threads);
  options.truth = &truth;
  options.error_unit = request.error_unit;
  const double usual_maximum = request.error_unit == VertexErrorUnit::kPixels ? 20 : 50;
  options.error_maximum = request.error_maximum > 0 ? request.error_maximum : usual_maximum;
  Image texture;
  std::vector<float> texels;
  if (!request.texture.empty()) {
    texture = ReadImage(request.texture);
    texels = TexelsOf(texture);
    options.texture = {texels, texture.width, texture.height, 3};
  }
  const std::vector<RenderStep> steps = StepsOf(request, first, end);
  FrameRenderer image(body, track, options, request.track);
  if (options.kind == RenderKind::kDepth) {
    std::vector<int> frames;
    frames.reserve(steps.size());
    for (const RenderStep& step : steps) frames.push_back(step.frame);
    image.SetDepthRange(frames);
  }
  const std::unique_ptr<RenderSink> sink =
      MakeRenderSink(request.out, options.kind, TitleOf(request, track, first, end), body, track, steps, options,
                     FrameRateOf(steps, track));

  RenderTrackReport report;
  report.what = ToString(request.what);
  report.first_frame = first, report.num_frames = end - first;
  report.width = track.camera.width, report.height = track.camera.height;
  for (int t = first; t < end; ++t) {
    report.without_body += track.frame_status[t] == FrameStatus::kLost;
  }
  callbacks.Begin("rendering " + std::to_string(report.num_frames) + " frames");
  const std::vector<int> wanted = sink->Wanted(static_cast<int>(steps.size()));
  for (const int i : wanted) {
    const Image* background = nullptr;
    if (video != nullptr) {
      background = video->At(track.motion.timestamps[steps[i].frame]);
      report.without_video += background == nullptr;
    }
    const Stopwatch draw;
    sink->Take(steps[i], background, &image);
    report.draw_seconds += draw.seconds();
    ++report.images;
    callbacks.Update("draw", static_cast<double>(report.images) / static_cast<double>(wanted.size()));
  }
  sink->Finish();
  report.legend = image.Legend();
  if (video != nullptr && !video->warning().empty()) callbacks.Message(video->warning());
  if (video != nullptr && end == track.num_frames()) {
    report.video_frames_left = video->FramesAfter(track.motion.timestamps.back());
  }
  report.outputs = {request.out};
  report.total_seconds = watch.seconds();
  if (!request.json.empty()) {
    report.outputs.push_back(request.json);
    WriteFileAtomically(request.json, ToJson(report));
  }
  return report;
}

}  // namespace

std::pair<int, int> FrameRange(const std::string& text, int num_frames, const std::string& where) {
  const auto number = [&](const std::string& digits, int missing) {
    if (digits.empty()) {
      return missing;
    }
    if (digits.size() > 9 || !std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; })) {
      throw RequestError("--frames " + text + ": expected a:b (frame b is left out), a:, :b, or one number");
    }
    return std::stoi(digits);
  };
  const size_t colon = text.find(':');
  int first = 0, end = num_frames;
  if (colon != std::string::npos) {
    first = number(text.substr(0, colon), 0);
    end = number(text.substr(colon + 1), num_frames);
  } else if (!text.empty()) {
    first = number(text, 0);
    end = first + 1;
  }
  if (first >= end) {
    throw RequestError("--frames " + text + ": holds no frame; a:b is frame a to frame b-1");
  }
  if (end > num_frames) {
    throw std::runtime_error(
        Concatenate(where, ": ", num_frames, " frames, expected --frames within 0:", num_frames, ", not ", text));
  }
  return {first, end};
}

RenderTrackReport RenderTrack(const RenderTrackRequest& request, const PipelineCallbacks& callbacks) {
  CheckOptions(request);
  RequireReadable(request.track, "track");
  RequireReadableBody(request.body);
  RequireReadable(request.truth, "truth");
  RequireDistinct({request.track, request.body, request.truth}, {request.out, request.json});
  CheckOtherFiles(request);
  const Track track = ReadTrack(request.track, MovingCamera::kTake);
  Track truth;
  if (!request.truth.empty()) truth = ReadTrack(request.truth, MovingCamera::kTake);
  return RenderChecked(request, *BodyOfTrack(request.body, track), track, request.truth.empty() ? nullptr : &truth,
                       callbacks);
}

RenderTrackReport RenderTrack(const RenderTrackRequest& request, const BodyModel& body, const Track& given,
                              const Track* given_truth, const PipelineCallbacks& callbacks) {
  CheckOptions(request);
  CheckOtherFiles(request);
  return RenderChecked(request, body, given, given_truth, callbacks);
}

std::string ToText(const RenderTrackReport& report) {
  std::string text = Concatenate(report.images, report.images == 1 ? " image" : " images", " of ", report.width, "x",
                                 report.height, "\n");
  if (!report.legend.empty()) {
    text += report.legend + "\n";
  }
  if (report.without_body > 0) {
    text += Concatenate(report.without_body, " of ", report.num_frames,
                        " frames are lost: they are shown without a body\n");
  }
  if (report.without_video > 0) {
    text += Concatenate(report.without_video, " of ", report.images,
                        " images have no video frame at their time: they have a plain background\n");
  }
  if (report.video_frames_left > 0) {
    text += Concatenate("the video goes on for ", report.video_frames_left, " frames after the track: left out\n");
  }
  for (const std::string& path : report.outputs) {
    text += "wrote " + path + "\n";
  }
  return text;
}

std::string ToJson(const RenderTrackReport& report) {
  nlohmann::ordered_json json;
  json["what"] = report.what;
  json["outputs"] = report.outputs;
  json["frames"] = {report.first_frame, report.first_frame + report.num_frames};
  json["pictures"] = report.images;
  json["frames_without_body"] = report.without_body;
  json["pictures_without_video"] = report.without_video;
  json["video_frames_left"] = report.video_frames_left;
  json["image_size"] = {report.width, report.height};
  json["legend"] = report.legend;
  json["seconds"] = {{"draw", report.draw_seconds}, {"total", report.total_seconds}};
  return json.dump(2) + "\n";
}

}  // namespace bodyloom
