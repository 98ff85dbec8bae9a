// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/world_drift.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "data_tools/evaluation/metrics.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/procrustes.h"

namespace bodyloom {
namespace {

constexpr double kAlignedSeconds = 1, kStandingMps = 0.1, kLongestStandingStepS = 0.1;

/// Joints of the frames that both have, below each other, and of which frame each block is.
struct JointsOfBoth {
  MatrixX3d track, truth;
  std::vector<int> frames;
};

JointsOfBoth StackJoints(const Track& track, const Track& truth, const BodyModel& body, const BodyModel& true_body) {
  const MatrixX3d rest = body.RestJoints(track.motion.betas), true_rest = true_body.RestJoints(truth.motion.betas);
  const auto joints_of = [](const BodyModel& of, const Motion& motion, const MatrixX3d& rest_joints, int t) {
    return PoseSkeleton(of, rest_joints,
                        PoseFromAxisAngle(of, motion.poses.row(t).transpose(), motion.trans.row(t).transpose()))
        .joints;
  };
  const Eigen::Index J = body.num_joints();
  JointsOfBoth both;
  for (int t = 0; t < truth.num_frames(); ++t) {
    if (track.HasResult(t) && truth.HasResult(t)) both.frames.push_back(t);
  }
  both.track.resize(J * static_cast<Eigen::Index>(both.frames.size()), 3);
  both.truth.resizeLike(both.track);
  for (size_t i = 0; i < both.frames.size(); ++i) {
    both.track.middleRows(J * static_cast<Eigen::Index>(i), J) = joints_of(body, track.motion, rest, both.frames[i]);
    both.truth.middleRows(J * static_cast<Eigen::Index>(i), J) =
        joints_of(true_body, truth.motion, true_rest, both.frames[i]);
  }
  return both;
}

MatrixX3d AlignedOn(const JointsOfBoth& both, Eigen::Index rows) {
  AlignmentOptions rigid;
  rigid.estimate_scale = false;
  return AlignPoints(both.track.topRows(rows), both.truth.topRows(rows), rigid).target_from_source.Apply(both.track);
}

GlobalErrors EmdbErrors(const JointsOfBoth& both, Eigen::Index num_joints) {
  const auto T = static_cast<Eigen::Index>(both.frames.size());
  std::vector<MatrixX3d> joints, true_joints;
  MatrixX3d roots(T, 3), true_roots(T, 3);
  for (Eigen::Index t = 0; t < T; ++t) {
    joints.emplace_back(both.track.middleRows(num_joints * t, num_joints));
    true_joints.emplace_back(both.truth.middleRows(num_joints * t, num_joints));
    roots.row(t) = joints.back().row(0);
    true_roots.row(t) = true_joints.back().row(0);
  }
  return MeasureGlobalErrors(joints, true_joints, roots, true_roots);
}

}  // namespace

WorldDrift MeasureWorldDrift(const Track& track, const Track& truth, const BodyModel& body,
                             const BodyModel* given_true_body) {
  const BodyModel& true_body = given_true_body != nullptr ? *given_true_body : body;
  BODYLOOM_CHECK(true_body.num_joints() == body.num_joints(), "world drift: the true body has ", true_body.num_joints(),
                 " joints, expected ", body.num_joints());
  BODYLOOM_CHECK(track.num_frames() == truth.num_frames(), "world drift: the track has ", track.num_frames(),
                 " frames, the truth has ", truth.num_frames());
  WorldDrift drift{kNotMeasured, kNotMeasured, kNotMeasured, kNotMeasured, {kNotMeasured, kNotMeasured, kNotMeasured}};
  const JointsOfBoth both = StackJoints(track, truth, body, true_body);
  if (both.frames.empty()) return drift;
  const Eigen::Index J = body.num_joints();
  const std::vector<double>& times = truth.motion.timestamps;
  Eigen::Index first = 0;
  while (first < static_cast<Eigen::Index>(both.frames.size()) &&
         times[both.frames[size_t(first)]] <= times[both.frames[0]] + kAlignedSeconds) {
    ++first;
  }
  drift.w_mpjpe_m = (AlignedOn(both, J * first) - both.truth).rowwise().norm().mean();
  const MatrixX3d aligned = AlignedOn(both, both.track.rows());
  drift.wa_mpjpe_m = (aligned - both.truth).rowwise().norm().mean();

  drift.emdb = EmdbErrors(both, J);

  const int left = body.FindJoint("l_ankle"), right = body.FindJoint("r_ankle");
  double way = 0, off = 0, slide = 0;
  int standing = 0;
  for (size_t i = 0; i < both.frames.size(); ++i) {
    const Eigen::Index row = J * static_cast<Eigen::Index>(i);
    off += (aligned.row(row) - both.truth.row(row)).norm() / static_cast<double>(both.frames.size());
    if (i == 0) continue;
    way += (both.truth.row(row) - both.truth.row(row - J)).norm();
    const double seconds = times[both.frames[i]] - times[both.frames[i - 1]];
    if (seconds > kLongestStandingStepS) continue;
    for (const int ankle : {left, right}) {
      if (ankle < 0) continue;
      const auto speed = [&](const MatrixX3d& joints) {
        return (joints.row(row + ankle) - joints.row(row - J + ankle)).norm() / seconds;
      };
      if (speed(both.truth) >= kStandingMps) continue;
      slide += speed(both.track);
      ++standing;
    }
  }
  if (way > 0) drift.root_drift = off / way;
  if (standing > 0) drift.foot_slide_mps = slide / standing;
  return drift;
}

void AddWorldDrift(const WorldDrift& drift, Evaluation* evaluation) {
  evaluation->Add("w_mpjpe_mm", drift.w_mpjpe_m * kMmPerMetre, "joint error in the world, aligned on the first second");
  evaluation->Add("wa_mpjpe_mm", drift.wa_mpjpe_m * kMmPerMetre, "joint error in the world, aligned on the whole clip");
  evaluation->Add("root_drift_percent", 100 * drift.root_drift, "pelvis error in the world / the way it went");
  evaluation->Add("w_mpjpe_100_mm", drift.emdb.w_mpjpe_100_m * kMmPerMetre,
                  "100 frames after a similarity of their first two (EMDB)");
  evaluation->Add("wa_mpjpe_100_mm", drift.emdb.wa_mpjpe_100_m * kMmPerMetre,
                  "100 frames after a similarity of all of them (EMDB)");
  evaluation->Add("rte_percent", 100 * drift.emdb.rte, "pelvis error after a rigid motion / length of its path (EMDB)");
  evaluation->Add("foot_slide_mps", drift.foot_slide_mps, "speed of ankles that truly stand, m/s");
}

}  // namespace bodyloom
