// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_cleaning.h"

#include <algorithm>
#include <cmath>

#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/smpl_rest.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/track.h"

namespace bodyloom {
namespace {

constexpr double kRounding = 1e-6;            // of times that are sums of frame steps
constexpr double kMidFlexion = 70 * kDegree;  // of a hip, between standing and crouching
constexpr double kMaxThighRoll = 110 * kDegree, kMaxTrunkTurn = 110 * kDegree, kMaxAnkleTurn = 110 * kDegree;

Eigen::Matrix3d RotationOf(const Motion& motion, int t, int j) {
  return RotationFromAxisAngle(motion.poses.block<1, 3>(t, 3 * j).transpose());
}

/// Angle of the rotation, [0, π]; files may hold vectors longer than π.
double TurnOf(const Motion& motion, int t, int j) { return AxisAngleFromRotation(RotationOf(motion, t, j)).norm(); }

/// Angle in [0, π] of the turn about y in R = swing · (turn about y).
double RollAboutY(const Eigen::Matrix3d& R) {
  const double roll = 2 * std::abs(std::atan2(R(0, 2) - R(2, 0), 1 + R.trace()));
  return std::min(roll, 2 * M_PI - roll);
}

/// Of the thigh about its own axis, [0, π], by the rotation of its hip.
double ThighRoll(const Eigen::Matrix3d& hip) {
  const Eigen::Matrix3d half_raised = RotationFromAxisAngle(Eigen::Vector3d::UnitX() * -kMidFlexion);
  const Eigen::Matrix3d swing = RotationBetweenDirections(-half_raised.col(1), -hip.col(1));
  return RollAboutY(half_raised.transpose() * swing.transpose() * hip);
}

bool IsBroken(const Motion& motion, int t) {
  for (const int hip : {1, 2}) {
    if (ThighRoll(RotationOf(motion, t, hip)) > kMaxThighRoll) return true;
  }
  const Eigen::Matrix3d trunk = RotationOf(motion, t, 3) * RotationOf(motion, t, 6) * RotationOf(motion, t, 9);
  return AxisAngleFromRotation(trunk).norm() > kMaxTrunkTurn;
}

Motion WithMendedFeet(const Motion& motion, int* frames_mended) {
  Motion mended = motion;
  *frames_mended = 0;
  for (int t = 0; t < motion.num_frames(); ++t) {
    bool is_mended = false;
    for (const int ankle : {7, 8}) {
      if (TurnOf(motion, t, ankle) <= kMaxAnkleTurn) continue;
      const int toe = ankle + 3;
      const Eigen::Vector3d foot = (SmplRestJoints().row(toe) - SmplRestJoints().row(ankle)).transpose();
      const Eigen::Vector3d pointed = RotationOf(motion, t, ankle) * foot;
      mended.poses.block<1, 3>(t, 3 * ankle) =
          AxisAngleFromRotation(RotationBetweenDirections(foot, pointed)).transpose();
      is_mended = true;
    }
    *frames_mended += is_mended;
  }
  return mended;
}

double MedianStep(const std::vector<double>& times) {
  if (times.size() < 2) return 0;
  std::vector<double> steps;
  for (size_t t = 1; t < times.size(); ++t) steps.push_back(times[t] - times[t - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Returns true if the step from frame t−1 to frame t exceeds a limit.
bool IsJump(const Motion& motion, const std::vector<MatrixX3d>& joints, int t, const MotionCleaningOptions& options) {
  const double dt = motion.timestamps[t] - motion.timestamps[t - 1];
  const MatrixX3d step = joints[t] - joints[t - 1];
  return step.row(0).norm() > options.max_pelvis_speed_m_s * dt ||
         (step.rowwise() - step.row(0)).rowwise().norm().maxCoeff() > options.max_joint_speed_m_s * dt ||
         RotationAngleBetween(RotationOf(motion, t - 1, 0), RotationOf(motion, t, 0)) >
             options.max_root_turn_rad_s * dt;
}

}  // namespace

Motion FramesOf(const Motion& motion, int begin, int end) {
  BODYLOOM_CHECK(begin >= 0 && begin <= end && end <= motion.num_frames(), "frames ", begin, " to ", end, " of ",
                 motion.num_frames());
  Motion piece;
  piece.body = motion.body;
  piece.betas = motion.betas;
  piece.up = motion.up;
  piece.poses = motion.poses.middleRows(begin, end - begin);
  piece.trans = motion.trans.middleRows(begin, end - begin);
  piece.timestamps.assign(motion.timestamps.begin() + begin, motion.timestamps.begin() + end);
  return piece;
}

CleanedMotion CleanMotion(const Motion& recorded, const MotionCleaningOptions& options) {
  CheckMotion(recorded, "CleanMotion");
  BODYLOOM_CHECK(recorded.poses.cols() == 72 && recorded.up == Motion::Up::kY,
                 "CleanMotion: ", recorded.poses.cols() / 3, " joints, expected 24 in a world with y up");
  CleanedMotion cleaned;
  const Motion motion = WithMendedFeet(recorded, &cleaned.frames_mended);
  const std::vector<double>& times = motion.timestamps;
  const int T = motion.num_frames();
  const double median_step = MedianStep(times);
  const std::vector<MatrixX3d> joints = PoseSmplJoints(motion);

  std::vector<char> is_out(T, 0), begins_piece(T, 0);
  const double margin_s = options.margin_s * (1 + kRounding);
  const auto leave_out_around = [&](int t) {
    for (int s = t; s >= 0 && times[t] - times[s] <= margin_s; --s) is_out[s] = 1;
    for (int s = t; s < T && times[s] - times[t] <= margin_s; ++s) is_out[s] = 1;
  };
  for (int t = 0; t < T; ++t) {
    if (IsBroken(motion, t)) {
      ++cleaned.frames_broken;
      leave_out_around(t);
    }
    if (t == 0) continue;
    const double dt = times[t] - times[t - 1];
    if (!(dt > 0 && dt <= options.longest_step * median_step)) {
      ++cleaned.gaps;
      begins_piece[t] = 1;
    } else if (IsJump(motion, joints, t, options)) {
      ++cleaned.jumps;
      begins_piece[t] = 1;
      leave_out_around(t - 1);
      leave_out_around(t);
    }
  }
  for (int begin = 0; begin < T;) {
    int end = begin + 1;
    while (end < T && !is_out[begin] && !is_out[end] && !begins_piece[end]) ++end;
    if (!is_out[begin] && times[end - 1] - times[begin] >= options.min_piece_s) {
      cleaned.pieces.push_back(FramesOf(motion, begin, end));
    } else {
      cleaned.frames_dropped += end - begin;
    }
    begin = end;
  }
  return cleaned;
}

}  // namespace bodyloom
