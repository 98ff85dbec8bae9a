// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/texture/extract_texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/data_tools/video/video_frame_times.h"
#include "bodyloom/data_tools/video/video_reader.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/report_json.h"
#include "bodyloom/pipelines/track/track_video.h"
#include "bodyloom/pipelines/track_fits_body.h"
#include "bodyloom/render/overlay.h"
#include "bodyloom/render/unit_byte.h"
#include "bodyloom/render/uv_fill.h"

namespace bodyloom {
namespace {

Image ColourImage(const Texture& texture, const std::vector<float>& planes) {
  Image image(texture.width, texture.height);
  const size_t pixels = size_t(texture.width) * texture.height;
  for (size_t p = 0; p < pixels; ++p) {
    for (size_t c = 0; c < 3; ++c) image.bgr[3 * p + c] = UnitByte(planes[c * pixels + p]);
  }
  return image;
}

Image GreyImage(const Texture& texture, const std::vector<float>& plane) {
  std::vector<float> planes;
  for (int c = 0; c < 3; ++c) planes.insert(planes.end(), plane.begin(), plane.end());
  return ColourImage(texture, planes);
}

struct Gathered {
  int used = 0, passed_over = 0, beyond_video = 0;  ///< frames of the track
};

/// Pixels around contours that are not used, when the user gave none: tracks are off by about a hundredth of the
/// person's height (of the joints, in the median frame).
int DefaultMargin(const Track& track) {
  std::vector<double> heights_px;
  for (int t = 0; t < static_cast<int>(track.joints.size()); ++t) {
    double low = 1e9, high = -1e9;
    Eigen::Vector2d pixel;
    for (Eigen::Index j = 0; j < track.joints[t].rows(); ++j) {
      if (!track.CameraAt(t).Project(track.joints[t].row(j).transpose(), &pixel)) continue;
      low = std::min(low, pixel.y());
      high = std::max(high, pixel.y());
    }
    if (high > low) heights_px.push_back(high - low);
  }
  if (heights_px.empty()) return 2;
  std::nth_element(heights_px.begin(), heights_px.begin() + heights_px.size() / 2, heights_px.end());
  return static_cast<int>(std::clamp(std::lround(0.01 * heights_px[heights_px.size() / 2]), 1L, 64L));
}

/// The video frame of the track's time zero. A video of just the track's frames, or one that is over before the track
/// begins, was cut to it: its first frame is the track's first, whatever the clock says.
int VideoOffset(const std::string& path, const Track& track) {
  const VideoInfo info = VideoReader(path).info();
  if (track.num_frames() == 0) return 0;
  const double fps = info.fps > 0 ? info.fps : VideoFrameRate(track.motion.timestamps);
  const int first = static_cast<int>(std::lround(track.motion.timestamps[0] * fps));
  const int num_frames = info.num_frames > 0 ? info.num_frames : static_cast<int>(VideoFrameTimes(path).size());
  const bool is_cut = num_frames > 0 && (num_frames == track.num_frames() || first >= num_frames);
  return is_cut ? -first : 0;
}

Gathered Gather(const ExtractTextureRequest& request, const BodyModel& body, const Track& track, TrackVideo* video,
                TextureExtractor* extractor, const PipelineCallbacks& callbacks) {
  Gathered gathered;
  callbacks.Begin("texture");
  for (int t = 0; t < track.num_frames(); t += request.every) {
    callbacks.Update("gathering", double(t) / track.num_frames());
    const FrameStatus status = track.frame_status[t];
    const MatrixX3d vertices = TrackVertices(body, track, t);
    if (vertices.rows() == 0 || (status != FrameStatus::kTracked && status != FrameStatus::kWeak)) {
      ++gathered.passed_over;
      continue;
    }
    const Image* frame = video->At(track.motion.timestamps[t]);
    if (frame == nullptr) {
      ++gathered.beyond_video;
      continue;
    }
    extractor->Add(*frame, vertices, track.CameraAt(t), t);
    ++gathered.used;
  }
  return gathered;
}

}  // namespace

ExtractTextureReport ExtractTexture(const ExtractTextureRequest& request, const PipelineCallbacks& callbacks) {
  StageClock clock;
  RequireReadable(request.track, "track");
  RequireReadable(request.video, "video");
  RequireReadable(request.body, "body model");
  RequireDistinct({request.track, request.video, request.body}, {request.out, request.confidence, request.json});
  for (const std::string& path : {request.out, request.confidence, request.json}) RequireWritable(path);
  const Track track_of_file = ReadTrack(request.track);
  if (track_of_file.camera.width == 0) {
    throw std::runtime_error(request.track + ": no image size, expected image_size so that the video can be matched");
  }
  TrackVideo video(request.video, track_of_file, NamedCamera().video_px_from_camera_px,
                   VideoOffset(request.video, track_of_file));
  const Track track = video.Moved(track_of_file);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(request.body);
  if (!body->has_uv()) {
    throw std::runtime_error(request.body +
                             ": a body without UV coordinates, expected vt and ft (bodyloom body convert "
                             "--uv adds them)");
  }
  RequireTrackFitsBody(track, *body, request.track);
  TextureExtractOptions options;
  options.texels.width = options.texels.height = request.size;
  options.edge_margin_px = request.margin_px >= 0 ? request.margin_px : DefaultMargin(track);
  options.merge = request.merge;
  clock.Begin("prepare");
  TextureExtractor extractor(*body, options);
  clock.Begin("gather");
  const Gathered gathered = Gather(request, *body, track, &video, &extractor, callbacks);
  if (!video.warning().empty()) callbacks.Say(video.warning());
  clock.Begin("merge");
  Texture texture = extractor.Merge();
  if (texture.num_seen == 0) {
    throw std::runtime_error(Concatenate(request.video, ": the body of ", request.track, " is seen in none of ",
                                         gathered.used, " frames, there is no texture"));
  }
  const UvTexelTable& table = extractor.table();
  clock.Begin("fill");
  std::vector<uint8_t> known(texture.confidence.size());
  for (size_t p = 0; p < known.size(); ++p)
    known[p] = texture.confidence[p] > (request.fill != TextureFill::kNone ? request.trust : 0);
  if (request.fill == TextureFill::kNone) {
    FillGutter(*body, table, known, 3, texture.bgr);
  } else if (request.fill == TextureFill::kLaplace) {
    LaplaceFill(*body, table, known).Fill(3, texture.bgr);
  } else {
    PyramidFill(*body, table).Fill(known, 3, texture.bgr);
  }
  clock.Begin("write");
  WriteImage(request.out, ColourImage(texture, texture.bgr));
  if (!request.confidence.empty()) WriteImage(request.confidence, GreyImage(texture, texture.confidence));
  clock.End();
  ExtractTextureReport report;
  report.out = request.out;
  report.width = texture.width, report.height = texture.height;
  report.track_frames = track.num_frames();
  report.frames_used = gathered.used;
  report.frames_without_fit = gathered.passed_over;
  report.frames_beyond_video = gathered.beyond_video;
  report.edge_margin_px = options.edge_margin_px;
  report.texels = table.num_inside;
  report.texels_seen = texture.num_seen;
  report.filled = request.fill != TextureFill::kNone;
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
