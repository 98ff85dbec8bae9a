// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_cuts.h"

#include <algorithm>

#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/smpl_rest.h"
#include "geometry/check.h"
#include "geometry/rotation.h"

namespace bodyloom {
namespace {

double MedianStep(const std::vector<double>& times) {
  std::vector<double> steps;
  for (size_t t = 1; t < times.size(); ++t) steps.push_back(times[t] - times[t - 1]);
  std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
  return steps[steps.size() / 2];
}

Eigen::Matrix3d RootOf(const Motion& motion, int t) {
  return RotationFromAxisAngle(motion.poses.block<1, 3>(t, 0).transpose());
}

}  // namespace

Motion FramesOf(const Motion& motion, int begin, int end) {
  BODYLOOM_CHECK(begin >= 0 && begin <= end && end <= motion.num_frames(), "frames ", begin, " to ", end, " of ",
                 motion.num_frames());
  Motion piece = motion;
  piece.poses = motion.poses.middleRows(begin, end - begin);
  piece.trans = motion.trans.middleRows(begin, end - begin);
  piece.timestamps.assign(motion.timestamps.begin() + begin, motion.timestamps.begin() + end);
  return piece;
}

MotionCuts CutMotion(const Motion& motion, const MotionCutOptions& options) {
  CheckMotion(motion, "CutMotion");
  BODYLOOM_CHECK(motion.poses.cols() == 72 && motion.up == Motion::Up::kY, "CutMotion: ", motion.poses.cols() / 3,
                 " joints, expected 24 in a world with y up");
  MotionCuts cuts;
  const int T = motion.num_frames();
  const double median_step = T > 1 ? MedianStep(motion.timestamps) : 0;
  const std::vector<MatrixX3d> joints = PoseSmplJoints(motion);
  int begin = 0;
  for (int t = 1; t <= T; ++t) {
    bool is_gap = false, is_jump = false;
    if (t < T) {
      const double dt = motion.timestamps[t] - motion.timestamps[t - 1];
      is_gap = !(dt > 0 && dt <= options.longest_step * median_step);
      if (!is_gap) {
        const MatrixX3d step = joints[t] - joints[t - 1];
        const double pelvis = step.row(0).norm() / dt;
        const double fastest = (step.rowwise() - step.row(0)).rowwise().norm().maxCoeff() / dt;
        const double turn = RotationAngleBetween(RootOf(motion, t - 1), RootOf(motion, t)) / dt;
        is_jump = pelvis > options.max_pelvis_speed_m_s || fastest > options.max_joint_speed_m_s ||
                  turn > options.max_root_turn_rad_s;
      }
      cuts.gaps += is_gap;
      cuts.jumps += is_jump;
    }
    if (t < T && !is_gap && !is_jump) continue;
    if (motion.timestamps[t - 1] - motion.timestamps[begin] >= options.min_piece_s) {
      cuts.pieces.push_back(FramesOf(motion, begin, t));
    } else {
      cuts.frames_dropped += t - begin;
    }
    begin = t;
  }
  return cuts;
}

}  // namespace bodyloom
