// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/resample_track.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "data_tools/motion/motion_tools.h"
#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom {
namespace {

constexpr double kLongestStep = 1.5;   ///< in steps
constexpr double kSameInstant = 1e-6;  ///< in steps of the new rate

/// Source of one frame of the result: between two frames of the track, or none (before = −1).
struct Instant {
  double time = 0;
  int before = -1, after = -1;
  double share = 0;  ///< of `after`
};

/// The instants of the result, in order.
std::vector<Instant> Plan(const Track& track, double fps) {
  const std::vector<double>& times = track.motion.timestamps;
  const int T = track.num_frames();
  const double longest = kLongestStep * std::max(1 / FrameRateWithoutGaps(track.motion), 1 / fps);
  std::vector<int> next_result(T + 1, T);  // the first frame with a result, from a frame on
  for (int t = T - 1; t >= 0; --t) next_result[t] = track.HasResult(t) ? t : next_result[t + 1];
  std::vector<Instant> instants;
  int now = 0, last_result = -1;  // the last frame that is not later, and the last of those that has a result
  if (track.HasResult(0)) last_result = 0;
  for (int64_t k = 0;; ++k) {
    const double time = times.front() + static_cast<double>(k) / fps, same = kSameInstant / fps;
    if (time > times.back() + same) break;
    while (now + 1 < T && times[now + 1] <= time + same) {
      if (track.HasResult(++now)) last_result = now;
    }
    const int after = now + 1 < T ? next_result[now + 1] : T;
    if (last_result == now && std::abs(times[now] - time) <= same) {
      instants.push_back({time, now, now, 0});
    } else if (last_result >= 0 && after < T && times[after] - times[last_result] <= longest) {
      instants.push_back({time, last_result, after, (time - times[last_result]) / (times[after] - times[last_result])});
    } else if (now + 1 < T && times[now + 1] - times[now] > longest) {
      // The timestamps jump: continue with the first instant that is not before the next frame.
      k = std::max(k, static_cast<int64_t>(std::ceil((times[now + 1] - times.front()) * fps - kSameInstant)) - 1);
    } else {
      instants.push_back({time});
    }
  }
  return instants;
}

}  // namespace

Track ResampleTrack(const Track& track, double fps) {
  BODYLOOM_CHECK(fps > 0 && fps < 1e5, "a track at ", fps, " frames a second, expected more than 0 and below 1e5");
  BODYLOOM_CHECK(track.num_frames() > 0, "resampling: the track has no frames");
  if (track.num_frames() == 1) return track;
  for (int t = 1; t < track.num_frames(); ++t) {
    BODYLOOM_CHECK(track.motion.timestamps[t] > track.motion.timestamps[t - 1], "resampling: frame ", t,
                   " is not later than the one before");
  }
  const std::vector<Instant> instants = Plan(track, fps);
  const auto T = static_cast<Eigen::Index>(instants.size());
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Track out;
  out.camera = track.camera;
  out.world = track.world;
  out.motion.body = track.motion.body;
  out.motion.betas = track.motion.betas;
  out.motion.up = track.motion.up;
  out.motion.poses = RowMatrixXd::Constant(T, track.motion.poses.cols(), kNone);
  out.motion.trans = MatrixX3d::Constant(T, 3, kNone);
  out.weak_camera = MatrixX3d::Constant(track.weak_camera.rows() > 0 ? T : 0, 3, kNone);
  out.level_m = Eigen::VectorXd::Zero(track.level_m.size() > 0 ? T : 0);
  for (int t = 0; t < T; ++t) {
    const auto& [time, before, after, share] = instants[t];
    out.motion.timestamps.push_back(time);
    out.frame_status.push_back(before < 0 ? FrameStatus::kLost : track.frame_status.at(share < 0.5 ? before : after));
    if (track.HasMovingCamera()) {
      // The camera keeps its last pose while the person is lost.
      out.camera_from_scene.push_back(
          before >= 0 ? InterpolatePoses(track.camera_from_scene.at(before), track.camera_from_scene.at(after), share)
          : t > 0     ? out.camera_from_scene.back()
                      : track.camera_from_scene.front());
    }
    if (before < 0) continue;
    if (out.level_m.size() > 0) out.level_m[t] = track.level_m[share < 0.5 ? before : after];
    if (before == after) {
      out.motion.poses.row(t) = track.motion.poses.row(before);
      out.motion.trans.row(t) = track.motion.trans.row(before);
    } else {
      InterpolateFrame(track.motion, before, after, share, t, &out.motion);
    }
    if (out.weak_camera.rows() == 0) continue;
    out.weak_camera.row(t) = (1 - share) * track.weak_camera.row(before) + share * track.weak_camera.row(after);
  }
  return out;
}

Track PlayedAtSpeed(const Track& track, double speed, double fps) {
  BODYLOOM_CHECK(speed >= 0.05 && speed <= 20, "speed ", speed, ", expected 0.05 to 20");
  for (int t = 0; t < track.num_frames(); ++t) {
    BODYLOOM_CHECK(track.HasResult(t), "frame ", t, " has no result: another speed needs a track without gaps");
  }
  const double own_fps = FrameRate(track.motion);
  BODYLOOM_CHECK(own_fps > 0, "another speed needs two frames or more with equal time between them");
  Track stretched = track;
  const double begin = track.motion.timestamps.front();
  for (double& time : stretched.motion.timestamps) time = begin + (time - begin) / speed;
  return ResampleTrack(stretched, fps > 0 ? fps : own_fps);
}

}  // namespace bodyloom
