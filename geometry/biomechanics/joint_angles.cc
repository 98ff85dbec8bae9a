// SPDX-License-Identifier: Apache-2.0
#include "geometry/biomechanics/joint_angles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/base/check.h"
#include "geometry/base/units.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kGimbalCosine = 1e-9;  // below it rounding alone decides about a and c
constexpr double kOrdinaryAngle = 75 * kDegree;

/// The angle plus the whole turns that bring it nearest to `target`.
double NearestTurn(double angle, double target) { return angle + kTurn * std::round((target - angle) / kTurn); }

Vector3d NearestTurns(const Vector3d& angles, const Vector3d& target) {
  return {NearestTurn(angles.x(), target.x()), NearestTurn(angles.y(), target.y()),
          NearestTurn(angles.z(), target.z())};
}

/// With |b| ≤ π/2. `a_at_gimbal` is taken where a is free.
Vector3d PrincipalZxy(const Matrix3d& R, double a_at_gimbal) {
  const double cosine = std::hypot(R(0, 1), R(1, 1)), b = std::atan2(R(2, 1), cosine);
  if (cosine > kGimbalCosine) return {std::atan2(-R(0, 1), R(1, 1)), b, std::atan2(-R(2, 0), R(2, 2))};
  const double sum = std::atan2(R(1, 0), R(0, 0));  // a + c at b = π/2, a − c at −π/2
  return {a_at_gimbal, b, b > 0 ? sum - a_at_gimbal : a_at_gimbal - sum};
}

// Sides: 0 right, 1 left, as OpenSim orders them.
enum Segment { kPelvisSegment, kTrunkSegment, kThigh, kShank = 4, kFoot = 6, kUpperArm = 8, kForearm = 10 };

struct SegmentRest {
  int segment;
  const char *joint, *end;  ///< without "r_": the joint that turns the segment, and the joint at its other end
};
constexpr std::array<SegmentRest, 5> kLimbSegments = {{{kThigh, "hip", "knee"},
                                                       {kShank, "knee", "ankle"},
                                                       {kFoot, "ankle", "foot"},
                                                       {kUpperArm, "shoulder", "elbow"},
                                                       {kForearm, "elbow", "wrist"}}};
constexpr std::array<const char*, 2> kSidePrefix = {"r_", "l_"};

// Columns of the coordinates.
constexpr int kPelvisColumn = 0, kPlaceColumn = 3, kLegColumn = 6, kLegColumns = 6, kLumbarColumn = 18, kArmColumn = 21,
              kArmColumns = 5;

/// LaiUhlrich2022's hip joint in its pelvis.
constexpr double kHipBehind_m = 0.056276, kHipBelow_m = 0.07849, kHipsWidth_m = 2 * 0.07726;

/// Columns forward, up and right in the body's axes.
Matrix3d BodyFrame() {
  Matrix3d frame;
  frame << 0, 0, -1,  //
      0, 1, 0,        //
      1, 0, 0;
  return frame;
}

/// The frame with the axis y, whose x is as near to `forward` as it can be.
Matrix3d FrameAlong(const Vector3d& y, const Vector3d& forward) {
  Matrix3d frame;
  frame.col(1) = y.normalized();
  frame.col(0) = (forward - forward.dot(frame.col(1)) * frame.col(1)).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

}  // namespace

const std::vector<std::string>& CoordinateNames() {
  static const std::vector<std::string> names = {
      "pelvis_tilt",      "pelvis_list",     "pelvis_rotation", "pelvis_tx",    "pelvis_ty",     "pelvis_tz",
      "hip_flexion_r",    "hip_adduction_r", "hip_rotation_r",  "knee_angle_r", "ankle_angle_r", "subtalar_angle_r",
      "hip_flexion_l",    "hip_adduction_l", "hip_rotation_l",  "knee_angle_l", "ankle_angle_l", "subtalar_angle_l",
      "lumbar_extension", "lumbar_bending",  "lumbar_rotation", "arm_flex_r",   "arm_add_r",     "arm_rot_r",
      "elbow_flex_r",     "pro_sup_r",       "arm_flex_l",      "arm_add_l",    "arm_rot_l",     "elbow_flex_l",
      "pro_sup_l"};
  return names;
}

int FindCoordinate(const std::string& name) {
  const auto found = std::find(CoordinateNames().begin(), CoordinateNames().end(), name);
  return found == CoordinateNames().end() ? -1 : static_cast<int>(found - CoordinateNames().begin());
}

bool IsAngle(int coordinate) { return coordinate < kPlaceColumn || coordinate >= kLegColumn; }

int RequireJoint(const BodyModel& body, const std::string& name, const char* what) {
  const int joint = body.FindJoint(name);
  BODYLOOM_CHECK(joint >= 0, what, ": the body '", body.name(), "' has no joint '", name, "'");
  return joint;
}

bool HasJointAngles(const BodyModel& body) {
  if (body.FindJoint("spine3") < 0) return false;
  for (const char* side : kSidePrefix) {
    for (const SegmentRest& limb : kLimbSegments) {
      if (body.FindJoint(side + std::string(limb.joint)) < 0 || body.FindJoint(side + std::string(limb.end)) < 0) {
        return false;
      }
    }
  }
  return true;
}

JointAngleReader::JointAngleReader(const BodyModel& body, const Eigen::VectorXd& betas, PelvisOrder order)
    : order_(order) {
  const MatrixX3d rest = body.RestJoints(betas);
  joint_[kPelvisSegment] = 0;
  const auto find = [&](const std::string& name) { return RequireJoint(body, name, "joint angles"); };
  joint_[kTrunkSegment] = find("spine3");
  rest_frame_[kPelvisSegment] = rest_frame_[kTrunkSegment] = BodyFrame();
  for (const int side : {0, 1}) {
    for (const SegmentRest& limb : kLimbSegments) {
      const auto segment = static_cast<size_t>(limb.segment + side);
      joint_[segment] = find(kSidePrefix[size_t(side)] + std::string(limb.joint));
      const int end = find(kSidePrefix[size_t(side)] + std::string(limb.end));
      const Vector3d along = (rest.row(joint_[segment]) - rest.row(end)).transpose();
      rest_frame_[segment] =
          limb.segment == kFoot ? FrameAlong(Vector3d::UnitY(), -along) : FrameAlong(along, Vector3d::UnitZ());
    }
    wrist_[size_t(side)] = find(kSidePrefix[size_t(side)] + std::string("wrist"));
    hip_[size_t(side)] = joint_[size_t(kThigh + side)];
  }
  const double scale = (rest.row(hip_[0]) - rest.row(hip_[1])).norm() / kHipsWidth_m;
  origin_from_mid_hip_ = scale * Vector3d(kHipBehind_m, kHipBelow_m, 0);
}

CoordinateRow JointAngleReader::Next(const PosedSkeleton& skeleton) {
  std::array<Vector3d, kCount> now;
  const auto before = [&](int rotation) { return before_ ? &(*before_)[size_t(rotation)] : nullptr; };
  const Matrix3d pelvis = Orientation(skeleton, kPelvisSegment), trunk = Orientation(skeleton, kTrunkSegment);
  CoordinateRow row;

  const bool tilt_first = order_ == PelvisOrder::kTiltFirst;
  now[kPelvis] = tilt_first ? CardanZxy(pelvis, before(kPelvis), CardanBranch::kTurning)
                            : CardanYxz(pelvis, before(kPelvis), CardanBranch::kTurning);
  row.segment<3>(kPelvisColumn) = (tilt_first ? now[kPelvis] : Vector3d(now[kPelvis].reverse())).transpose() / kDegree;
  row.segment<3>(kPlaceColumn) =
      0.5 * (skeleton.joints.row(hip_[0]) + skeleton.joints.row(hip_[1])) + (pelvis * origin_from_mid_hip_).transpose();
  now[kLumbar] = CardanZxy(pelvis.transpose() * trunk, before(kLumbar));
  row.segment<3>(kLumbarColumn) = now[kLumbar].transpose() / kDegree;

  for (const int side : {0, 1}) {
    const double sign = side == 0 ? 1 : -1;
    const Vector3d signs(1, sign, sign);
    const auto angles = [&](int rotation, const Matrix3d& parent, const Matrix3d& child) -> const Vector3d& {
      return now[size_t(rotation + side)] = CardanZxy(parent.transpose() * child, before(rotation + side));
    };
    const Matrix3d thigh = Orientation(skeleton, kThigh + side), shank = Orientation(skeleton, kShank + side),
                   upper_arm = Orientation(skeleton, kUpperArm + side),
                   forearm = Orientation(skeleton, kForearm + side);
    const int leg = kLegColumn + side * kLegColumns, arm = kArmColumn + side * kArmColumns;
    row.segment<3>(leg) = angles(kHips, pelvis, thigh).cwiseProduct(signs).transpose() / kDegree;
    row[leg + 3] = -angles(kKnees, thigh, shank).x() / kDegree;
    const Vector3d& ankle = angles(kAnkles, shank, Orientation(skeleton, kFoot + side));
    row[leg + 4] = ankle.x() / kDegree;
    row[leg + 5] = sign * ankle.y() / kDegree;
    row.segment<3>(arm) = angles(kArms, trunk, upper_arm).cwiseProduct(signs).transpose() / kDegree;
    const Vector3d& elbow = angles(kElbows, upper_arm, forearm);
    // The hand with the forearm's axes at rest, so that its rotation in them is the wrist's.
    const Matrix3d hand = skeleton.world_rotations[size_t(wrist_[size_t(side)])] * rest_frame_[size_t(kForearm + side)];
    Vector3d& wrist = now[size_t(kWrists + side)];
    wrist = CardanYxz(forearm.transpose() * hand, before(kWrists + side));
    row[arm + 3] = elbow.x() / kDegree;
    row[arm + 4] = 90 + sign * (elbow.z() + wrist.x()) / kDegree;
  }
  before_ = now;
  return row;
}

Vector3d CardanZxy(const Matrix3d& R, const Vector3d* before, CardanBranch branch) {
  const Vector3d principal = PrincipalZxy(R, before != nullptr ? before->x() : 0);
  if (before == nullptr) return principal;
  const Vector3d near = NearestTurns(principal, *before);
  if (branch == CardanBranch::kTurning) return {near.x(), principal.y(), near.z()};
  if (principal.cwiseAbs().maxCoeff() <= kOrdinaryAngle) return principal;
  const Vector3d other =
      NearestTurns(principal + Vector3d(0.5 * kTurn, 0.5 * kTurn - 2 * principal.y(), 0.5 * kTurn), *before);
  return (near - *before).squaredNorm() <= (other - *before).squaredNorm() ? near : other;
}

// Rᵀ = Rz(−c) Rx(−b) Ry(−a).
Vector3d CardanYxz(const Matrix3d& R, const Vector3d* before, CardanBranch branch) {
  if (before == nullptr) return -CardanZxy(R.transpose(), nullptr, branch).reverse();
  const Vector3d turned = -before->reverse();
  return -CardanZxy(R.transpose(), &turned, branch).reverse();
}

}  // namespace bodyloom
