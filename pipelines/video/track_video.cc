// SPDX-License-Identifier: Apache-2.0
#include "pipelines/video/track_video.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

bool IsScaledCopy(const Camera& camera, int width, int height) {
  const double sx = double(width) / camera.width, sy = double(height) / camera.height;
  return std::abs(sx / sy - 1) <= 0.01;
}

}  // namespace

Matrix2x3d VideoFromCameraPixels(const Matrix2x3d& map, const Camera& camera, int width, int height,
                                 const std::string& path) {
  if (!map.isApprox(NamedCamera().video_px_from_camera_px)) {
    return map;
  }
  if (!IsScaledCopy(camera, width, height)) {
    throw std::runtime_error(Concatenate(path, ": frames of ", width, "x", height, ", expected those of the camera, ",
                                         camera.width, "x", camera.height, ", or a scaled copy of them"));
  }
  return ScaleOfPixels({camera.width, camera.height}, {width, height});
}

Matrix2x3d VideoFromCameraPixels(const Matrix2x3d& map, const Camera& camera, const VideoInfo& video,
                                 const std::string& path) {
  const bool has_map = !map.isApprox(NamedCamera().video_px_from_camera_px);
  const bool in_stored_pixels = !IsScaledCopy(camera, video.width, video.height) &&
                                IsScaledCopy(camera, video.stored_width, video.stored_height) &&
                                camera.model == CameraModel::kPinhole;
  if (has_map || !in_stored_pixels) return VideoFromCameraPixels(map, camera, video.width, video.height, path);
  return ScaleOfPixels({camera.width, camera.height}, {video.width, video.height});
}

Matrix2x3d ScaleOfPixels(const Eigen::Vector2i& from, const Eigen::Vector2i& to) {
  const double sx = double(to.x()) / from.x(), sy = double(to.y()) / from.y();
  // Pixel centres lie at integers, so the image's corner (-0.5, -0.5) is what stays.
  return (Matrix2x3d() << sx, 0, 0.5 * (sx - 1), 0, sy, 0.5 * (sy - 1)).finished();
}

Camera CameraOfMappedPixels(Camera camera, const Matrix2x3d& map, int width, int height) {
  camera.fx *= map(0, 0);
  camera.fy *= map(1, 1);
  camera.cx = map(0, 0) * camera.cx + map(0, 2);
  camera.cy = map(1, 1) * camera.cy + map(1, 2);
  camera.scale *= map(0, 0);
  camera.width = width;
  camera.height = height;
  return camera;
}

double PlayedFps(const VideoInfo& video, double fps) {
  constexpr double kUsualFps = 30;
  if (video.fps > 0) return video.fps;
  return fps > 0 ? fps : kUsualFps;
}

VideoPlayback PlaybackOf(const VideoInfo& video, int turn_deg, double captured_fps, double fps) {
  return {turn_deg, captured_fps > 0 ? captured_fps / PlayedFps(video, fps) : 1};
}

TrackVideo::TrackVideo(const std::string& path, const Track& track, const Matrix2x3d& map, int video_offset)
    : reader_(path, track.playback.turn_deg),
      map_(VideoFromCameraPixels(map, track.camera, reader_.info(), path)),
      slowdown_(track.playback.slowdown),
      offset_(video_offset) {
  fps_ = info().fps > 0 ? info().fps : VideoFrameRate(track.motion.timestamps) / slowdown_;
  times_ = VideoFrameTimes(path);
}

Track TrackVideo::Moved(Track track) const {
  track.camera = CameraOfMappedPixels(track.camera, map_, info().width, info().height);
  if (track.weak_camera.rows() > 0) {
    track.weak_camera.col(0) *= map_(0, 0);
  }
  return track;
}

int TrackVideo::IndexAt(double time_s) const {
  const double played_s = time_s * slowdown_;
  if (times_.empty()) return static_cast<int>(std::lround(played_s * fps_)) + offset_;
  // The track's time zero, and by it the track's time, on the video's clock.
  const int last = int(times_.size()) - 1;
  const double zero =
      offset_ < 0 ? offset_ / fps_ : times_[size_t(std::min(offset_, last))] + std::max(0, offset_ - last) / fps_;
  const double time = zero + played_s, half_frame = 0.5 / fps_;
  if (time < -half_frame) return -1;
  if (time > times_.back() + half_frame) return last + 1;
  const auto after = std::lower_bound(times_.begin(), times_.end(), time);
  if (after == times_.end()) return last;
  const int index = int(after - times_.begin());
  return index > 0 && time - times_[size_t(index) - 1] < *after - time ? index - 1 : index;
}

int TrackVideo::FramesAfter(double time_s) const {
  const int num_frames = times_.empty() ? info().num_frames : int(times_.size());
  return std::max(0, num_frames - 1 - IndexAt(time_s));
}

const Image* TrackVideo::At(double time_s) {
  const int index = IndexAt(time_s);
  if (index < 0) {
    return nullptr;
  }
  if (index >= reader_.next_frame()) {
    reader_.Skip(index - reader_.next_frame());
    has_frame_ = reader_.Read(&frame_);
  }
  return has_frame_ ? &frame_ : nullptr;
}

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

}  // namespace bodyloom
