// SPDX-License-Identifier: Apache-2.0
#include "pipelines/video/track_video.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "data_tools/video/video_frame_times.h"
#include "geometry/base/check.h"

namespace bodyloom {
Matrix2x3d VideoFromCameraPixels(const Matrix2x3d& map, const Camera& camera, int width, int height,
                                 const std::string& path) {
  if (!map.isApprox(NamedCamera().video_px_from_camera_px)) {
    return map;
  }
  const double sx = static_cast<double>(width) / camera.width, sy = static_cast<double>(height) / camera.height;
  if (!(std::abs(sx / sy - 1) <= 0.01)) {
    throw std::runtime_error(Concatenate(path, ": frames of ", width, "x", height, ", expected those of the camera, ",
                                         camera.width, "x", camera.height, ", or a scaled copy of them"));
  }
  // Pixel centres lie at integers, so the image's corner (-0.5, -0.5) is what stays.
  return (Matrix2x3d() << sx, 0, 0.5 * (sx - 1), 0, sy, 0.5 * (sy - 1)).finished();
}

TrackVideo::TrackVideo(const std::string& path, const Track& track, const Matrix2x3d& map, int video_offset)
    : reader_(path),
      map_(VideoFromCameraPixels(map, track.camera, reader_.info().width, reader_.info().height, path)),
      offset_(video_offset) {
  fps_ = info().fps > 0 ? info().fps : VideoFrameRate(track.motion.timestamps);
  times_ = VideoFrameTimes(path);
}

Track TrackVideo::Moved(Track track) const {
  // The map's shear (2e-4 in real files) is left out: 0.2 px at the border.
  Camera& camera = track.camera;
  camera.fx *= map_(0, 0);
  camera.fy *= map_(1, 1);
  camera.cx = map_(0, 0) * camera.cx + map_(0, 2);
  camera.cy = map_(1, 1) * camera.cy + map_(1, 2);
  camera.scale *= map_(0, 0);
  camera.width = info().width;
  camera.height = info().height;
  if (track.weak_camera.rows() > 0) {
    track.weak_camera.col(0) *= map_(0, 0);
  }
  return track;
}

int TrackVideo::IndexAt(double time_s) const {
  if (times_.empty()) return static_cast<int>(std::lround(time_s * fps_)) + offset_;
  // The track's time zero, and by it the track's time, on the video's clock.
  const int last = int(times_.size()) - 1;
  const double zero =
      offset_ < 0 ? offset_ / fps_ : times_[size_t(std::min(offset_, last))] + std::max(0, offset_ - last) / fps_;
  const double time = zero + time_s, half_frame = 0.5 / fps_;
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
