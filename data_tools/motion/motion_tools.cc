// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_tools.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/track.h"

namespace bodyloom {
namespace {

constexpr double kClockTolerance = 0.01;

/// y-up world from a world with that up: proper rotations.
Eigen::Matrix3d YUpFrom(Motion::Up up) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (up == Motion::Up::kZ) R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  if (up == Motion::Up::kCamera) R << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  return R;
}

/// Four fifths of the frames are no higher: people stand more often than they jump.
double StandingHeight(const Eigen::VectorXd& heights) {
  std::vector<double> sorted(heights.begin(), heights.end());
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(0.8 * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace

Motion ChangeUp(const Motion& motion, Motion::Up up, const Eigen::Vector3d& rest_pelvis) {
  BODYLOOM_CHECK(up != Motion::Up::kCamera, "ChangeUp: a camera frame cannot be made from a world without its camera");
  Motion turned = motion;
  turned.up = up;
  if (motion.up == up) return turned;
  const Eigen::Matrix3d R = YUpFrom(up).transpose() * YUpFrom(motion.up);
  for (int t = 0; t < motion.num_frames(); ++t) {
    const Eigen::Matrix3d root = R * RotationFromAxisAngle(motion.poses.block<1, 3>(t, 0).transpose());
    turned.poses.block<1, 3>(t, 0) = AxisAngleFromRotation(root).transpose();
    const Eigen::Vector3d pelvis = rest_pelvis + motion.trans.row(t).transpose();
    turned.trans.row(t) = (R * pelvis - rest_pelvis).transpose();
  }
  return turned;
}

Motion ResampleMotion(const Motion& motion, double fps) {
  CheckMotion(motion, "ResampleMotion");
  BODYLOOM_CHECK(fps > 0 && fps < 1e5, "ResampleMotion: frame rate ", fps, " must be positive");
  if (motion.num_frames() < 2) return motion;
  const std::vector<double>& times = motion.timestamps;
  const int T = static_cast<int>(std::floor((times.back() - times.front()) * fps + 1e-6)) + 1;
  Motion out = motion;
  out.poses.resize(T, motion.poses.cols());
  out.trans.resize(T, 3);
  out.timestamps.resize(T);
  size_t next = 1;
  for (int t = 0; t < T; ++t) {
    const double time = times.front() + t / fps;
    while (next + 1 < times.size() && times[next] < time) ++next;
    const double s = std::clamp((time - times[next - 1]) / (times[next] - times[next - 1]), 0.0, 1.0);
    out.timestamps[t] = time;
    InterpolateFrame(motion, static_cast<int>(next) - 1, static_cast<int>(next), s, t, &out);
  }
  return out;
}

void InterpolateFrame(const Motion& motion, int before, int after, double share, int to, Motion* out) {
  out->trans.row(to) = (1 - share) * motion.trans.row(before) + share * motion.trans.row(after);
  for (int j = 0; 3 * j < motion.poses.cols(); ++j) {
    const Eigen::Matrix3d a = RotationFromAxisAngle(motion.poses.block<1, 3>(before, 3 * j).transpose());
    const Eigen::Matrix3d b = RotationFromAxisAngle(motion.poses.block<1, 3>(after, 3 * j).transpose());
    out->poses.block<1, 3>(to, 3 * j) = AxisAngleFromRotation(InterpolateRotation(a, b, share)).transpose();
  }
}

Motion TakeFrames(const Motion& motion, int first, int count, int step) {
  BODYLOOM_CHECK(first >= 0 && count > 0 && step > 0 && first + int64_t{count - 1} * step < motion.num_frames(),
                 "TakeFrames: frames ", first, " + ", step, "·(0 … ", count - 1, ") of ", motion.num_frames());
  Motion taken = motion;
  taken.poses.resize(count, motion.poses.cols());
  taken.trans.resize(count, 3);
  taken.timestamps.resize(count);
  for (int i = 0; i < count; ++i) {
    taken.poses.row(i) = motion.poses.row(first + i * step);
    taken.trans.row(i) = motion.trans.row(first + i * step);
    taken.timestamps[i] = motion.timestamps[first + i * step];
  }
  return taken;
}

Motion JoinMotions(const std::vector<Motion>& motions, double gap_s) {
  BODYLOOM_CHECK(!motions.empty() && gap_s > 0, "JoinMotions: ", motions.size(), " motions, ", gap_s, " s apart");
  Motion joined = motions.front();
  int frames = 0;
  for (const Motion& motion : motions) {
    CheckMotion(motion, "JoinMotions");
    BODYLOOM_CHECK(motion.num_frames() > 0 && motion.poses.cols() == joined.poses.cols() && motion.up == joined.up,
                   "JoinMotions: a motion of ", motion.num_frames(), " frames and ", motion.poses.cols() / 3,
                   " joints beside one of ", joined.poses.cols() / 3, ", or with another axis up");
    frames += motion.num_frames();
  }
  const int height = joined.up == Motion::Up::kZ ? 2 : 1;
  const double level = StandingHeight(motions.front().trans.col(height));
  joined.poses.resize(frames, joined.poses.cols());
  joined.trans.resize(frames, 3);
  joined.timestamps.clear();
  int at = 0;
  for (const Motion& motion : motions) {
    const int T = motion.num_frames();
    joined.poses.middleRows(at, T) = motion.poses;
    Eigen::RowVector3d centre = motion.trans.colwise().mean();
    centre[height] = StandingHeight(motion.trans.col(height)) - level;
    joined.trans.middleRows(at, T) = motion.trans.rowwise() - centre;
    const double begin = joined.timestamps.empty() ? 0 : joined.timestamps.back() + gap_s;
    for (const double time : motion.timestamps) joined.timestamps.push_back(begin + time - motion.timestamps.front());
    at += T;
  }
  return joined;
}

double FrameRate(const Motion& motion) {
  const std::vector<double>& times = motion.timestamps;
  if (times.size() < 2) return 0;
  const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (size_t t = 1; t < times.size(); ++t) {
    if (!(std::abs(times[t] - times[t - 1] - step) < kClockTolerance * step)) return 0;
  }
  return 1 / step;
}

double FrameRateWithoutGaps(const Motion& motion) {
  const std::vector<double>& times = motion.timestamps;
  std::vector<double> steps;
  for (size_t t = 1; t < times.size(); ++t) steps.push_back(times[t] - times[t - 1]);
  const double longest = 1.5 * Percentile(steps, 50);
  double sum = 0;
  int count = 0;
  for (const double step : steps) {
    if (!(step <= longest)) continue;
    sum += step;
    ++count;
  }
  return sum > 0 ? count / sum : 0;
}

}  // namespace bodyloom
