// SPDX-License-Identifier: Apache-2.0
#include "apps/overlay_video.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "data_tools/video/video_reader.h"
#include "data_tools/video/video_writer.h"
#include "geometry/check.h"
#include "render/overlay.h"

namespace bodyloom {
namespace {

/// The camera whose pixels are the video's. The map's shear (2e-4 in real files) is left out: 0.2 px at the border.
Camera CameraOfVideo(const Camera& camera, const Matrix2x3d& map, int width, int height) {
  Camera moved = camera;
  moved.fx *= map(0, 0);
  moved.fy *= map(1, 1);
  moved.cx = map(0, 0) * camera.cx + map(0, 2);
  moved.cy = map(1, 1) * camera.cy + map(1, 2);
  moved.scale *= map(0, 0);
  moved.width = width;
  moved.height = height;
  return moved;
}

/// The map for a video that is a scaled copy of what the camera saw; `map` itself when it says more than identity.
Matrix2x3d MapToVideo(const Matrix2x3d& map, const Camera& camera, const VideoInfo& video, const std::string& path) {
  if (!map.isApprox(NamedCamera().video_px_from_camera_px)) {
    return map;
  }
  const double sx = static_cast<double>(video.width) / camera.width,
               sy = static_cast<double>(video.height) / camera.height;
  if (std::abs(sx / sy - 1) > 0.01) {
    throw std::runtime_error(Concatenate(path, ": frames of ", video.width, "x", video.height,
                                         ", expected those of the camera, ", camera.width, "x", camera.height,
                                         ", or a scaled copy of them"));
  }
  // Pixel centres lie at integers, so the image's corner (-0.5, -0.5) is what stays.
  return (Matrix2x3d() << sx, 0, 0.5 * (sx - 1), 0, sy, 0.5 * (sy - 1)).finished();
}

KeypointSequence MovedKeypoints(KeypointSequence keypoints, const Matrix2x3d& map, int width, int height) {
  for (Keypoint& point : keypoints.points) {
    const Eigen::Vector2d moved = map * Eigen::Vector3d(point.x, point.y, 1);
    point.x = static_cast<float>(moved.x());
    point.y = static_cast<float>(moved.y());
  }
  keypoints.image_width = width;
  keypoints.image_height = height;
  return keypoints;
}

/// Hands out video frames by index, forwards only.
class FrameSource {
 public:
  explicit FrameSource(const std::string& path) : reader_(path) {}
  [[nodiscard]] const VideoInfo& info() const { return reader_.info(); }
  /// Null past the end and before the beginning.
  const Image* At(int index) {
    if (index < 0) {
      return nullptr;
    }
    if (index >= reader_.next_frame()) {
      reader_.Skip(index - reader_.next_frame());
      has_frame_ = reader_.Read(&frame_);
    }
    return has_frame_ ? &frame_ : nullptr;
  }

 private:
  VideoReader reader_;
  Image frame_;
  bool has_frame_ = false;
};

}  // namespace

double VideoFrameRate(const std::vector<double>& timestamps) {
  std::vector<double> steps;
  for (size_t t = 1; t < timestamps.size(); ++t) {
    steps.push_back(timestamps[t] - timestamps[t - 1]);
  }
  if (steps.empty()) {
    return 30;
  }
  std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
  return std::clamp(1 / steps[steps.size() / 2], 1.0, 240.0);
}

OverlaySummary WriteOverlayVideo(const std::string& path, const OverlayVideo& what) {
  Track track = *what.track;
  KeypointSequence detected = what.detected != nullptr ? *what.detected : KeypointSequence();
  const double fps = VideoFrameRate(track.motion.timestamps);
  std::unique_ptr<FrameSource> frames;
  double video_fps = fps;
  if (!what.video.empty()) {
    frames = std::make_unique<FrameSource>(what.video);
    const VideoInfo& info = frames->info();
    video_fps = info.fps > 0 ? info.fps : fps;
    const Matrix2x3d map = MapToVideo(what.video_px_from_camera_px, track.camera, info, what.video);
    track.camera = CameraOfVideo(track.camera, map, info.width, info.height);
    if (track.weak_camera.rows() > 0) {
      track.weak_camera.col(0) *= map(0, 0);
    }
    detected = MovedKeypoints(std::move(detected), map, info.width, info.height);
  }
  OverlayOptions options;
  options.side_view = what.side_view;
  const OverlayRenderer renderer(*what.body, track, options, what.reference);
  VideoWriter writer(path, renderer.width(), renderer.height(), fps);
  OverlaySummary summary;
  for (int t = 0; t < track.num_frames(); ++t) {
    OverlayFrame frame;
    frame.detected = what.detected != nullptr ? &detected : nullptr;
    if (frames != nullptr) {
      const int index = static_cast<int>(std::lround(track.motion.timestamps[t] * video_fps)) + what.video_offset;
      frame.background = frames->At(index);
      summary.frames_without_video += frame.background == nullptr;
    }
    frame.caption = {{Concatenate("frame ", t, ", ", ToString(track.frame_status[t]))}};
    writer.Write(renderer.Render(t, frame));
    ++summary.frames;
    what.progress(static_cast<double>(t + 1) / track.num_frames());
  }
  writer.Finish();
  return summary;
}

}  // namespace bodyloom
