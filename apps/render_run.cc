// SPDX-License-Identifier: Apache-2.0
#include "apps/render_run.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/progress.h"
#include "apps/render_picture.h"
#include "apps/render_sinks.h"
#include "apps/track_video.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

constexpr int kPicturesOfAHeldPose = 120, kCellsOfAHeldPose = 12;  // one turn: 4 s, or a contact sheet

double Now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void CheckOptions(const RenderCommand& command) {
  const bool is_npz = command.out.ends_with(".npz");
  if (!is_npz && !command.out.ends_with(".mp4") && !command.out.ends_with(".png")) {
    throw RequestError("--out " + command.out + ": expected a name that ends in .mp4, .png or .npz");
  }
  if (command.what == "texture" && command.texture.empty()) {
    throw RequestError("--what texture needs the picture to put on the body: give --texture FILE");
  }
  if (command.what != "texture" && !command.texture.empty()) {
    throw RequestError("--texture is only seen with --what texture, not with --what " + command.what);
  }
  if (!command.video.empty() && (command.has_view_yaw || command.turntable)) {
    throw RequestError(
        "a video shows the person from its own camera alone: give --video, or --view-yaw and --turntable");
  }
  if (is_npz && !command.video.empty() && command.what != "overlay" && command.what != "texture") {
    throw RequestError("arrays of " + command.what +
                       " hold the surface alone: leave --video out, or write .mp4 or .png");
  }
}

void CheckFiles(const RenderCommand& command) {
  RequireReadable(command.track, "track");
  RequireReadable(command.body, "body model");
  RequireReadable(command.video, "video");
  RequireReadable(command.texture, "texture");
  RequireDistinct({command.track, command.body, command.video, command.texture}, {command.out, command.json});
  RequireWritable(command.out);
  RequireWritable(command.json);
}

void CheckTrack(const RenderCommand& command, const Track& track, const BodyModel& body) {
  if (track.motion.poses.cols() > 3 * body.num_joints()) {
    throw std::runtime_error(Concatenate(command.track, ": ", track.motion.poses.cols() / 3, " joints (body '",
                                         track.motion.body, "'), the body '", body.name(), "' has ", body.num_joints(),
                                         "; give the track's own with --body"));
  }
}

std::vector<RenderStep> StepsOf(const RenderCommand& command, int first, int end) {
  const int frames = end - first;
  const int held = command.out.ends_with(".png") ? kCellsOfAHeldPose : kPicturesOfAHeldPose;
  const int count = command.turntable && frames == 1 ? held : frames;
  std::vector<RenderStep> steps;
  for (int i = 0; i < count; ++i) {
    steps.push_back({frames == 1 ? first : first + i, command.turntable ? 360.0 * i / count : 0});
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

std::vector<std::string> TitleOf(const RenderCommand& command, const Track& track, int first, int end) {
  std::string what = command.what + " of " + std::filesystem::path(command.track).filename().string();
  if (!command.video.empty()) {
    what += " over " + std::filesystem::path(command.video).filename().string();
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

RenderReport RunRender(const RenderCommand& command) {
  const double start = Now();
  CheckOptions(command);
  CheckFiles(command);
  Track track = ReadTrack(command.track);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(command.body);
  CheckTrack(command, track, *body);
  const auto [first, end] = FrameRange(command.frames, track.num_frames(), command.track);

  std::unique_ptr<TrackVideo> video;
  if (!command.video.empty()) {
    if (track.camera.width <= 0) {  // a track that does not tell was made in the pixels of its video
      const VideoInfo info = VideoReader(command.video).info();
      track.camera.width = info.width, track.camera.height = info.height;
    }
    video = std::make_unique<TrackVideo>(command.video, track);
    track = video->Moved(std::move(track));
  }

  RenderPictureOptions options;
  options.kind = RenderKindFromString(command.what);
  options.new_view = command.has_view_yaw || command.turntable;
  options.view_yaw_deg = command.view_yaw_deg;
  options.turntable = command.turntable;
  options.num_threads =
      command.num_threads > 0 ? command.num_threads : std::max(1U, std::thread::hardware_concurrency());
  Image texture;
  std::vector<float> texels;
  if (!command.texture.empty()) {
    texture = ReadImage(command.texture);
    texels = TexelsOf(texture);
    options.texture = {texels, texture.width, texture.height, 3};
  }
  const std::vector<RenderStep> steps = StepsOf(command, first, end);
  RenderPicture picture(*body, track, options, command.track);
  if (options.kind == RenderKind::kDepth) {
    std::vector<int> frames;
    for (const RenderStep& step : steps) {
      frames.push_back(step.frame);
    }
    picture.SetDepthRange(frames);
  }
  const std::unique_ptr<RenderSink> sink =
      MakeRenderSink(command.out, options.kind, TitleOf(command, track, first, end), *body, track, steps, options,
                     FrameRateOf(steps, track));

  RenderReport report;
  report.what = command.what, report.out = command.out;
  report.first_frame = first, report.num_frames = end - first;
  report.width = track.camera.width, report.height = track.camera.height;
  for (int t = first; t < end; ++t) {
    report.without_body += track.frame_status[t] == FrameStatus::kLost;
  }
  Progress progress("rendering " + std::to_string(report.num_frames) + " frames",
                    command.quiet ? Progress::Style::kSilent : Progress::DefaultStyle());
  const std::vector<int> wanted = sink->Wanted(static_cast<int>(steps.size()));
  for (const int i : wanted) {
    ThrowIfInterrupted();
    const Image* background = nullptr;
    if (video != nullptr) {
      background = video->At(track.motion.timestamps[steps[i].frame]);
      report.without_video += background == nullptr;
    }
    const double before = Now();
    sink->Take(steps[i], background, &picture);
    report.draw_seconds += Now() - before;
    ++report.pictures;
    progress.Update("draw", static_cast<double>(report.pictures) / static_cast<double>(wanted.size()));
  }
  ThrowIfInterrupted();
  sink->Finish();
  report.legend = picture.Legend();
  if (video != nullptr && end == track.num_frames()) {
    report.video_frames_left = video->FramesAfter(track.motion.timestamps.back());
  }
  report.outputs = {command.out};
  report.total_seconds = Now() - start;
  if (!command.json.empty()) {
    report.outputs.push_back(command.json);
    WriteFileAtomically(command.json, ToJson(report));
  }
  return report;
}

std::string ToText(const RenderReport& report) {
  std::string text = Concatenate(report.pictures, report.pictures == 1 ? " picture" : " pictures", " of ", report.width,
                                 "x", report.height, "\n");
  if (!report.legend.empty()) {
    text += report.legend + "\n";
  }
  if (report.without_body > 0) {
    text += Concatenate(report.without_body, " of ", report.num_frames,
                        " frames are lost: they are shown without a body\n");
  }
  if (report.without_video > 0) {
    text += Concatenate(report.without_video, " of ", report.pictures,
                        " pictures have no video frame at their time: they have a plain background\n");
  }
  if (report.video_frames_left > 0) {
    text += Concatenate("the video goes on for ", report.video_frames_left, " frames after the track: left out\n");
  }
  for (const std::string& path : report.outputs) {
    text += "wrote " + path + "\n";
  }
  return text;
}

std::string ToJson(const RenderReport& report) {
  nlohmann::ordered_json json;
  json["what"] = report.what;
  json["outputs"] = report.outputs;
  json["frames"] = {report.first_frame, report.first_frame + report.num_frames};
  json["pictures"] = report.pictures;
  json["frames_without_body"] = report.without_body;
  json["pictures_without_video"] = report.without_video;
  json["video_frames_left"] = report.video_frames_left;
  json["image_size"] = {report.width, report.height};
  json["legend"] = report.legend;
  json["seconds"] = {{"draw", report.draw_seconds}, {"total", report.total_seconds}};
  return json.dump(2) + "\n";
}

}  // namespace bodyloom
