// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/motion_quality.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/motion_floor.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/smpl_rest.h"
#include "geometry/base/check.h"
#include "geometry/body/body_model.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/track.h"
#include "tracking/terms/joint_limits.h"

namespace bodyloom {
namespace {

constexpr int kHead = 15;
constexpr std::array<int, 2> kToes{10, 11};
constexpr double kContactHeight_m = 0.05, kStillVertical_m_s = 0.2, kSunk_m = 0.05;
constexpr double kTolerance_rad = 5 * M_PI / 180;
constexpr double kFlipTurn_rad_s = 20, kFlipCosine = -0.5;

Eigen::Matrix3d RotationOf(const Motion& motion, int t, int j) {
  return RotationFromAxisAngle(motion.poses.block<1, 3>(t, 3 * j).transpose());
}

/// Keeps the largest value and whose it is.
void Keep(double value, int joint, double* largest, std::string* name) {
  if (value <= *largest) return;
  *largest = value;
  *name = SmplJointNames()[joint];
}

bool IsEnd(int joint) { return joint == 7 || joint == 8 || joint == 10 || joint == 11 || joint >= 20; }

void MeasureLimits(const Motion& motion, MotionQuality* quality) {
  static const JointLimits limits = JointLimits::ForBody(BuiltinBody());
  double worst_rad[2] = {0, 0};  // of the body, of the ends
  int beyond[2] = {0, 0};
  for (int t = 0; t < motion.num_frames(); ++t) {
    double frame_rad[2] = {0, 0};
    for (const JointLimits::Range& range : limits.ranges) {
      const bool is_end = IsEnd(range.joint);
      const Eigen::Vector3d axis_angle = AxisAngleFromRotation(RotationOf(motion, t, range.joint));
      const double excess = LimitExcess(range, axis_angle).cwiseAbs().maxCoeff();
      frame_rad[is_end] = std::max(frame_rad[is_end], excess);
      Keep(excess, range.joint, &worst_rad[is_end],
           is_end ? &quality->ends_worst_excess_joint : &quality->worst_excess_joint);
    }
    for (const int end : {0, 1}) beyond[end] += frame_rad[end] > kTolerance_rad;
  }
  quality->beyond_limits_share = static_cast<double>(beyond[0]) / motion.num_frames();
  quality->ends_beyond_limits_share = static_cast<double>(beyond[1]) / motion.num_frames();
  quality->worst_excess_deg = worst_rad[0] * 180 / M_PI;
  quality->ends_worst_excess_deg = worst_rad[1] * 180 / M_PI;
}

void MeasureFloor(const std::vector<MatrixX3d>& joints, double dt, MotionQuality* quality) {
  const int T = static_cast<int>(joints.size());
  std::vector<double> speeds;
  int sunk = 0;
  for (int t = 0; t < T; ++t) {
    const double lowest = LowestPoint(joints[t]);
    sunk += lowest < -kSunk_m;
    quality->deepest_m = std::max(quality->deepest_m, -lowest);
    if (t == 0) continue;
    double slowest = INFINITY;
    for (const int toe : kToes) {
      const double highest = std::max(joints[t](toe, 1), joints[t - 1](toe, 1)) - JointClearance(toe);
      if (highest > kContactHeight_m) continue;
      const Eigen::RowVector3d step = joints[t].row(toe) - joints[t - 1].row(toe);
      if (std::abs(step.y()) > kStillVertical_m_s * dt) continue;
      slowest = std::min(slowest, std::hypot(step.x(), step.z()) / dt);
    }
    if (std::isfinite(slowest)) speeds.push_back(slowest);
  }
  quality->sunk_share = static_cast<double>(sunk) / T;
  quality->contact_share = static_cast<double>(speeds.size()) / std::max(T - 1, 1);
  quality->foot_sliding_m_s = quality->foot_sliding_p95_m_s = NAN;
  if (speeds.empty()) return;
  std::sort(speeds.begin(), speeds.end());
  quality->foot_sliding_m_s = 0;
  for (const double speed : speeds) quality->foot_sliding_m_s += speed / static_cast<double>(speeds.size());
  quality->foot_sliding_p95_m_s = speeds[static_cast<size_t>(0.95 * static_cast<double>(speeds.size() - 1))];
}

void MeasureSpeeds(const std::vector<MatrixX3d>& joints, double dt, MotionQuality* quality) {
  for (size_t t = 1; t < joints.size(); ++t) {
    const MatrixX3d step = joints[t] - joints[t - 1];
    for (int j = 0; j < 24; ++j) {
      Keep((step.row(j) - step.row(0)).norm() / dt, j, &quality->worst_speed_m_s, &quality->worst_speed_joint);
      if (t + 1 == joints.size()) continue;
      const Eigen::RowVector3d second = joints[t + 1].row(j) - joints[t].row(j) - step.row(j);
      Keep(second.norm() / (dt * dt), j, &quality->worst_acceleration_m_s2, &quality->worst_acceleration_joint);
    }
  }
}

void MeasureTurns(const Motion& motion, double dt, MotionQuality* quality) {
  for (int j = 0; j < 24; ++j) {
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    for (int t = 1; t < motion.num_frames(); ++t) {
      const Eigen::Vector3d rate =
          AxisAngleFromRotation(RotationOf(motion, t - 1, j).transpose() * RotationOf(motion, t, j)) / dt;
      Keep(rate.norm(), j, &quality->worst_turn_rad_s, &quality->worst_turn_joint);
      const bool both_fast = rate.norm() > kFlipTurn_rad_s && before.norm() > kFlipTurn_rad_s;
      const bool is_flip = both_fast && rate.dot(before) < kFlipCosine * rate.norm() * before.norm();
      (IsEnd(j) ? quality->ends_flips : quality->flips) += is_flip;
      before = rate;
    }
  }
}

}  // namespace

MotionQuality MeasureMotionQuality(const Motion& motion, bool has_floor) {
  CheckMotion(motion, "MeasureMotionQuality");
  MotionQuality quality;
  quality.fps = FrameRate(motion);
  BODYLOOM_CHECK(motion.poses.cols() == 72 && motion.up == Motion::Up::kY && quality.fps > 0,
                 "MeasureMotionQuality: expected 24 joints, y up and a regular clock");
  quality.frames = motion.num_frames();
  quality.seconds = motion.timestamps.back() - motion.timestamps.front();
  const double dt = 1 / quality.fps;
  const std::vector<MatrixX3d> joints = PoseSmplJoints(motion);
  MeasureLimits(motion, &quality);
  MeasureFloor(joints, dt, &quality);
  MeasureSpeeds(joints, dt, &quality);
  MeasureTurns(motion, dt, &quality);
  if (!has_floor) {
    quality.foot_sliding_m_s = quality.foot_sliding_p95_m_s = quality.contact_share = quality.sunk_share =
        quality.deepest_m = NAN;
  }
  const auto upside_down =
      std::count_if(joints.begin(), joints.end(), [](const MatrixX3d& frame) { return frame(kHead, 1) < frame(0, 1); });
  const auto flag = [&quality](bool is_so, const char* word) {
    if (is_so) quality.flags.emplace_back(word);
  };
  flag(quality.beyond_limits_share > 0.2 || quality.worst_excess_deg > 40, "limits");
  flag(quality.ends_beyond_limits_share > 0.2 || quality.ends_worst_excess_deg > 40, "ends");
  flag(quality.flips > 0, "flips");
  flag(quality.foot_sliding_m_s > 0.3, "foot_sliding");
  flag(quality.sunk_share > 0.1, "sunk");
  flag(quality.worst_speed_m_s > 20, "speed");
  flag(quality.worst_acceleration_m_s2 > 1000, "acceleration");
  flag(2 * upside_down > quality.frames, "upside_down");
  return quality;
}

}  // namespace bodyloom
