// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/track_angles.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"

namespace bodyloom {

using Eigen::Vector3d;

namespace {

/// A limb of two segments: joints root, middle, end, and the columns of the angles that their positions determine.
struct LimbJoints {
  std::array<int, 3> joints;
  int flexion, adduction, bend;
};

std::array<LimbJoints, 4> LimbsOf(const BodyModel& body) {
  const auto limb = [&](const std::string& side, std::array<const char*, 3> joints, const char* flexion,
                        const char* adduction, const char* bend) {
    LimbJoints result{};
    for (size_t k = 0; k < 3; ++k) result.joints[k] = body.FindJoint(side + "_" + joints[k]);
    result.flexion = FindCoordinate(std::string(flexion) + "_" + side);
    result.adduction = FindCoordinate(std::string(adduction) + "_" + side);
    result.bend = FindCoordinate(std::string(bend) + "_" + side);
    return result;
  };
  const std::array<const char*, 3> leg = {"hip", "knee", "ankle"}, arm = {"shoulder", "elbow", "wrist"};
  return {limb("r", leg, "hip_flexion", "hip_adduction", "knee_angle"),
          limb("l", leg, "hip_flexion", "hip_adduction", "knee_angle"),
          limb("r", arm, "arm_flex", "arm_add", "elbow_flex"), limb("l", arm, "arm_flex", "arm_add", "elbow_flex")};
}

/// Standard deviation, radians, of the angle at p between the directions to b and c.
double BendSigma(const std::array<Vector3d, 3>& b_p_c, const std::array<double, 3>& sigma) {
  const Vector3d u = b_p_c[0] - b_p_c[1], v = b_p_c[2] - b_p_c[1];
  // In the plane of both; of segments in line any plane, the same for both, serves.
  Vector3d normal = u.cross(v);
  if (normal.norm() < 1e-9 * u.norm() * v.norm()) normal = u.unitOrthogonal();
  normal.normalize();
  const Vector3d along_u = u.cross(normal).normalized() / u.norm(), along_v = normal.cross(v).normalized() / v.norm();
  return std::sqrt(sigma[0] * sigma[0] / u.squaredNorm() + sigma[2] * sigma[2] / v.squaredNorm() +
                   sigma[1] * sigma[1] * (along_u + along_v).squaredNorm());
}

/// Of frame t, whose coordinates are `values`.
void AddSigma(const std::array<LimbJoints, 4>& limbs, int chest, const std::array<int, 2>& hips,
              const MatrixX3d& joints, const Eigen::RowVectorXd& joint_sigma, const CoordinateRow& values,
              Eigen::Ref<Eigen::RowVectorXd> sigma_deg) {
  const auto sigma = [&](int joint) {
    return joint < joint_sigma.size() ? joint_sigma[joint] : std::numeric_limits<double>::quiet_NaN();
  };
  const Vector3d mid_hip = 0.5 * (joints.row(hips[0]) + joints.row(hips[1])).transpose();
  const double trunk = std::pow(sigma(chest), 2) / (joints.row(chest).transpose() - mid_hip).squaredNorm();
  for (const LimbJoints& limb : limbs) {
    std::array<Vector3d, 3> places;
    std::array<double, 3> sigmas{};
    for (size_t k = 0; k < 3; ++k) {
      places[k] = joints.row(limb.joints[k]).transpose();
      sigmas[k] = sigma(limb.joints[k]);
    }
    const double limb_share = (sigmas[0] * sigmas[0] + sigmas[1] * sigmas[1]) / (places[1] - places[0]).squaredNorm();
    const double swing_deg = std::sqrt(limb_share + trunk) / kDegree;
    sigma_deg[limb.adduction] = swing_deg;
    sigma_deg[limb.flexion] = swing_deg / std::abs(std::cos(values[limb.adduction] * kDegree));
    sigma_deg[limb.bend] = BendSigma(places, sigmas) / kDegree;
  }
}

}  // namespace

PosedSkeleton SkeletonInWorld(const BodyModel& body, const MatrixX3d& rest_joints, const Motion& motion, int t,
                              const WorldFrame& world) {
  PosedSkeleton skeleton = PoseSkeleton(
      body, rest_joints, PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose()));
  for (Eigen::Matrix3d& rotation : skeleton.world_rotations) rotation = world.rotation * rotation;
  skeleton.joints = world.PointsFromCamera(skeleton.joints);
  return skeleton;
}

TrackAngles AnglesOfTrack(const BodyModel& body, const Track& track, const WorldFrame& world, PelvisOrder order) {
  const Motion& motion = track.motion;
  const int T = motion.num_frames();
  BODYLOOM_CHECK(motion.poses.cols() <= 3 * body.num_joints(), "joint angles: the track has ", motion.poses.cols() / 3,
                 " joints, the body '", body.name(), "' ", body.num_joints());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TrackAngles angles;
  angles.timestamps = motion.timestamps;
  angles.values.setConstant(T, kNumCoordinates, nan);
  angles.sigma_deg.setConstant(T, kNumCoordinates, nan);
  JointAngleReader reader(body, motion.betas, order);
  const MatrixX3d rest = body.RestJoints(motion.betas);
  const std::array<LimbJoints, 4> limbs = LimbsOf(body);
  const int chest = body.FindJoint("spine3");
  for (int t = 0; t < T; ++t) {
    if (!motion.HasPose(t)) {
      reader.Restart();
      continue;
    }
    const PosedSkeleton skeleton = SkeletonInWorld(body, rest, motion, t, world);
    const CoordinateRow row = reader.Next(skeleton);
    angles.values.row(t) = row;
    if (t < track.joint_sigma.rows()) {
      AddSigma(limbs, chest, HipJoints(body), skeleton.joints, track.joint_sigma.row(t), row, angles.sigma_deg.row(t));
    }
  }
  return angles;
}

}  // namespace bodyloom
