// SPDX-License-Identifier: Apache-2.0
#include "pipelines/texture/extract_texture.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/track.h"
#include "pipelines/body_of_track.h"
#include "pipelines/files.h"
#include "pipelines/report_json.h"
#include "pipelines/video/track_video.h"

namespace bodyloom {
namespace {

struct Gathered {
  int used = 0, passed_over = 0, beyond_video = 0;  ///< frames of the track
};

/// The video frame of the track's time zero. A video of just the track's frames, or one that is over before the track
/// begins, was cut to it: its first frame is the track's first, whatever the clock says.
int VideoOffset(const std::string& path, const Track& track) {
  const VideoInfo info = VideoReader(path, track.playback.turn_deg).info();
  if (track.num_frames() == 0) return 0;
  const double slowdown = track.playback.slowdown;
  const double fps = info.fps > 0 ? info.fps : VideoFrameRate(track.motion.timestamps) / slowdown;
  const int first = static_cast<int>(std::lround(track.motion.timestamps[0] * slowdown * fps));
  const int num_frames = info.num_frames > 0 ? info.num_frames : static_cast<int>(VideoFrameTimes(path).size());
  const bool is_cut = num_frames > 0 && (num_frames == track.num_frames() || first >= num_frames);
  return is_cut ? -first : 0;
}

Gathered Gather(const ExtractTextureRequest& request, const Track& track, TrackVideo* video, PersonTexture* texture,
                const PipelineCallbacks& callbacks) {
  Gathered gathered;
  callbacks.Begin("texture");
  for (int t = 0; t < track.num_frames(); t += request.every) {
    callbacks.Update("gathering", double(t) / track.num_frames());
    const bool is_fitted = HasFitOfItsOwn(track, t);
    const Image* frame = is_fitted ? video->At(track.motion.timestamps[t]) : nullptr;
    if (frame != nullptr) texture->Add(t, *frame);
    gathered.used += frame != nullptr;
    gathered.beyond_video += is_fitted && frame == nullptr;
    gathered.passed_over += !is_fitted;
  }
  return gathered;
}

}  // namespace

ExtractTextureReport ExtractTexture(const ExtractTextureRequest& request, const PipelineCallbacks& callbacks) {
  StageClock clock;
  RequireReadable(request.track, "track");
  RequireReadable(request.video, "video");
  RequireReadableBody(request.body);
  RequireDistinct({request.track, request.video, request.body}, {request.out, request.confidence, request.json});
  for (const std::string& path : {request.out, request.confidence, request.json}) RequireWritable(path);
  const Track track_of_file = ReadTrack(request.track, MovingCamera::kTake);
  if (track_of_file.camera.width == 0) {
    throw std::runtime_error(request.track + ": no image size, expected image_size so that the video can be matched");
  }
  TrackVideo video(request.video, track_of_file, NamedCamera().video_px_from_camera_px,
                   VideoOffset(request.video, track_of_file));
  Track track = video.Moved(track_of_file);
  const std::shared_ptr<const BodyModel> body = BodyOfTrack(request.body, track);
  if (!body->has_uv()) {
    throw std::runtime_error(request.body +
                             ": a body without UV coordinates, expected vt and ft (bodyloom body convert "
                             "--uv adds them)");
  }
  RequireTrackFitsBody(track, *body, request.track);
  track = TrackInCameras(*body, track);
  clock.Begin("prepare");
  PersonTexture texture(*body, track, request.texture);
  clock.Begin("gather");
  const Gathered gathered = Gather(request, track, &video, &texture, callbacks);
  if (!video.warning().empty()) callbacks.Message(video.warning());
  clock.Begin("merge");
  const std::optional<PersonTextureImages> images = texture.Merge();
  if (!images) {
    throw std::runtime_error(Concatenate(request.video, ": the body of ", request.track, " is seen in none of ",
                                         gathered.used, " frames, there is no texture"));
  }
  clock.Begin("write");
  WriteImage(request.out, images->colours);
  if (!request.confidence.empty()) WriteImage(request.confidence, images->confidence);
  clock.End();
  ExtractTextureReport report;
  report.out = request.out;
  report.width = images->colours.width, report.height = images->colours.height;
  report.track_frames = track.num_frames();
  report.frames_used = gathered.used;
  report.frames_without_fit = gathered.passed_over;
  report.frames_beyond_video = gathered.beyond_video;
  report.edge_margin_px = texture.edge_margin_px();
  report.texels = texture.texels();
  report.texels_seen = images->texels_seen;
  report.filled = request.texture.fill != TextureFill::kNone;
  report.seconds = clock.seconds();
  report.total_seconds = clock.total();
  if (!request.json.empty()) WriteFileAtomically(request.json, ToJson(report));
  return report;
}

std::string ToJson(const ExtractTextureReport& report) {
  const nlohmann::ordered_json seconds = ToJson(report.seconds);
  const nlohmann::ordered_json json = {{"size", {report.width, report.height}},
                                       {"track_frames", report.track_frames},
                                       {"frames_beyond_video", report.frames_beyond_video},
                                       {"edge_margin_px", report.edge_margin_px},
                                       {"frames_used", report.frames_used},
                                       {"frames_without_fit", report.frames_without_fit},
                                       {"texels", report.texels},
                                       {"texels_seen", report.texels_seen},
                                       {"filled", report.filled},
                                       {"seconds", seconds}};
  return json.dump(1) + "\n";
}

std::string ToText(const ExtractTextureReport& report) {
  const double seen = double(report.texels_seen) / report.texels;
  char line[160];
  std::snprintf(line, sizeof line, "%d frames show %.1f %% of the body%s\n", report.frames_used, 100 * seen,
                report.filled ? ", the rest is filled" : "");
  std::string text = line;
  if (report.frames_beyond_video > 0) {
    text += "note     " + std::to_string(report.frames_beyond_video) +
            " frames of the track lie beyond the end of the video\n";
  }
  text += "time     ";
  for (const auto& [stage, stage_seconds] : report.seconds) {
    std::snprintf(line, sizeof line, "%s %.2f, ", stage.c_str(), stage_seconds);
    text += line;
  }
  std::snprintf(line, sizeof line, "in all %.2f s\n", report.total_seconds);
  return text + line + "wrote    " + report.out + "\n";
}

}  // namespace bodyloom
