// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/inverse_kinematics.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tracking/initialise/joint_hypotheses.h"
#include "tracking/initialise/joint_rays.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Orthonormal axes with the first along `along` and the second as near as possible to `normal`.
Matrix3d Triad(const Vector3d& along, const Vector3d& normal) {
  Matrix3d axes;
  axes.col(0) = along.normalized();
  axes.col(1) = (normal - axes.col(0) * axes.col(0).dot(normal)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

struct Limb {
  const char *upper, *hinge, *end;
  Vector3d hinge_axis;  ///< rest frame; a positive turn flexes
};

const Limb kBodyLimbs[4] = {
    {"l_shoulder", "l_elbow", "l_wrist", {0, -1, 0}},
    {"r_shoulder", "r_elbow", "r_wrist", {0, 1, 0}},
    {"l_hip", "l_knee", "l_ankle", {1, 0, 0}},
    {"r_hip", "r_knee", "r_ankle", {1, 0, 0}},
};

/// sin of the bend below which the shortest swing begins to decide the twist.
constexpr double kStraight = 0.2;

}  // namespace

BodyPose PoseFromJoints(const BodyModel& model, const MatrixX3d& rest_joints, const MatrixX3d& rest_points,
                        const MatrixX3d& points, const Matrix3d& torso_rotation) {
  BODYLOOM_CHECK(points.rows() == 17 && rest_points.rows() == 17, "inverse kinematics: ", points.rows(), " points and ",
                 rest_points.rows(), " rest points, expected 17 of each");
  BodyPose pose;
  pose.rotations.assign(model.num_joints(), Matrix3d::Identity());
  Matrix3d rest_torso = Matrix3d::Identity();
  BODYLOOM_CHECK(TorsoFrame(rest_points, &rest_torso), "inverse kinematics: the body's rest pose has no torso");
  pose.rotations[0] = torso_rotation * rest_torso.transpose();
  for (int l = 0; l < 4; ++l) {
    const Limb& limb = kBodyLimbs[l];
    const int upper = model.FindJoint(limb.upper), hinge = model.FindJoint(limb.hinge), end = model.FindJoint(limb.end);
    BODYLOOM_CHECK(upper >= 0 && hinge >= 0 && end >= 0, "inverse kinematics: the body '", model.name(),
                   "' has no joint ", limb.upper, ", ", limb.hinge, " or ", limb.end);
    const Vector3d start = points.row(kLimbs[l][0]), middle = points.row(kLimbs[l][1]), tip = points.row(kLimbs[l][2]);
    const Vector3d upper_bone = middle - start, lower_bone = tip - middle;
    if (!upper_bone.allFinite() || !(upper_bone.norm() > 0)) continue;
    const Matrix3d parent = pose.rotations[0];  // the trunk between root and limb is at rest
    const Vector3d rest_upper = (rest_joints.row(hinge) - rest_joints.row(upper)).transpose();
    const Vector3d rest_lower = (rest_joints.row(end) - rest_joints.row(hinge)).transpose();
    const Matrix3d shortest = RotationBetweenDirections(parent * rest_upper, upper_bone) * parent;
    Matrix3d world = shortest;
    if (lower_bone.allFinite() && lower_bone.norm() > 0) {
      const Vector3d normal = upper_bone.normalized().cross(lower_bone.normalized());
      const double known = normal.norm() / kStraight;
      const Vector3d blended = known >= 1 ? normal : normal + (1 - known) * kStraight * (shortest * limb.hinge_axis);
      if (blended.norm() > 1e-9) {
        world = Triad(upper_bone, blended) * Triad(rest_upper, limb.hinge_axis).transpose();
      }
      pose.rotations[hinge] = RotationBetweenDirections(rest_lower, world.transpose() * lower_bone);
    }
    pose.rotations[upper] = parent.transpose() * world;
  }
  const Vector3d rest_hips = (rest_points.row(11) + rest_points.row(12)).transpose() / 2;
  const Vector3d hips = (points.row(11) + points.row(12)).transpose() / 2;
  const Vector3d pelvis = rest_joints.row(0).transpose();
  pose.trans = hips - (pelvis + pose.rotations[0] * (rest_hips - pelvis));
  return pose;
}

using Eigen::Vector2d;
using namespace hypotheses_internal;  // NOLINT(google-build-using-namespace)

Eigen::VectorXd EstimateShape(const KeypointSequence& keypoints, const Camera& camera, const BodyModel& model,
                              int num_betas, const JointHypothesesOptions& options) {
  Eigen::VectorXd betas = Eigen::VectorXd::Zero(num_betas);
  std::vector<int> frames;
  const int step = std::max(1, keypoints.num_frames() / 1000);
  for (int t = 0; t < keypoints.num_frames(); t += step) frames.push_back(t);
  const std::vector<Rays> rays = RaysOfFrames(keypoints, camera, frames, options);

  // Bones as pairs of point groups: torso, then the two bones of each limb, left and right together.
  const auto midpoint = [](const auto& points, int a, int b) -> Vector2d { return (points(a) + points(b)) / 2; };
  constexpr int kNumBones = 5;
  std::array<std::vector<double>, kNumBones> seen;
  for (const Rays& r : rays) {
    if (!r.has_torso()) continue;
    const auto at = [&](int k) -> Vector2d { return r.ray[k]; };
    std::array<double, kNumBones> length{};
    std::array<int, kNumBones> count{};
    length[0] = (midpoint(at, kLeftShoulder, kRightShoulder) - midpoint(at, kLeftHip, kRightHip)).norm();
    count[0] = 1;
    for (int l = 0; l < 4; ++l) {
      for (int b = 0; b < 2; ++b) {
        const int from = kLimbs[l][b], to = kLimbs[l][b + 1];
        if (!r.seen[from] || !r.seen[to] || std::min(r.confidence[from], r.confidence[to]) < 0.5) continue;
        // The longer of left and right: the other is foreshortened.
        double& longest = length[1 + 2 * (l / 2) + b];
        longest = std::max(longest, (at(to) - at(from)).norm());
        count[1 + 2 * (l / 2) + b] = 1;
      }
    }
    if (count[0] + count[3] + count[4] < 3) continue;
    const double size = length[0] + length[3] + length[4];
    if (!(size > 0)) continue;
    for (int b = 0; b < kNumBones; ++b) {
      if (count[b] > 0) seen[b].push_back(length[b] / size);
    }
  }
  Eigen::VectorXd log_seen(kNumBones);
  for (int b = 0; b < kNumBones; ++b) {
    if (seen[b].size() < 30) return betas;
    // The ratio to the body's apparent size is noisy both ways for torso and legs (median), and only shortened for
    // arms.
    const size_t k = static_cast<size_t>((b == 0 || b >= 3 ? 0.5 : 0.85) * static_cast<double>(seen[b].size() - 1));
    std::nth_element(seen[b].begin(), seen[b].begin() + static_cast<std::ptrdiff_t>(k), seen[b].end());
    log_seen[b] = std::log(seen[b][k]);
  }
  const auto log_lengths = [&](const Eigen::VectorXd& shape) {
    BodyPose rest;
    rest.rotations.assign(model.num_joints(), Matrix3d::Identity());
    const Lengths lengths(PoseLandmarks(model, shape, rest, CocoNames()));
    Eigen::VectorXd result(kNumBones);
    result << lengths.torso, (lengths.upper[0] + lengths.upper[1]) / 2, (lengths.lower[0] + lengths.lower[1]) / 2,
        (lengths.upper[2] + lengths.upper[3]) / 2, (lengths.lower[2] + lengths.lower[3]) / 2;
    const double size = result[0] + result[3] + result[4];
    return Eigen::VectorXd((result / size).array().log());
  };
  const Eigen::VectorXd mean = log_lengths(betas);
  Eigen::MatrixXd A(kNumBones, num_betas);
  for (int b = 0; b < num_betas; ++b) A.col(b) = log_lengths(Eigen::VectorXd::Unit(num_betas, b)) - mean;
  constexpr double kSigma = 0.03;
  const Eigen::MatrixXd H = A.transpose() * A / (kSigma * kSigma) + Eigen::MatrixXd::Identity(num_betas, num_betas);
  // People do not differ by more; a larger ratio means wrong detections.
  constexpr double kLimit = 0.35;
  const Eigen::VectorXd difference = (log_seen - mean).cwiseMax(-kLimit).cwiseMin(kLimit);
  return H.ldlt().solve(A.transpose() * difference / (kSigma * kSigma));
}

}  // namespace bodyloom
