// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/retarget.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "data_tools/motion/skeleton_map.h"
#include "data_tools/motion/smpl_rest.h"
#include "geometry/body/body_model.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// SMPL joint numbers, left side; the right one is the next.
enum Smpl {
  kPelvis = 0,
  kHip = 1,
  kSpine1 = 3,
  kKnee = 4,
  kSpine2 = 6,
  kAnkle = 7,
  kSpine3 = 9,
  kToe = 10,
  kNeck = 12,
  kCollar = 13,
  kHead = 15,
  kShoulder = 16,
  kElbow = 18,
  kWrist = 20
};

/// A limb must bend this much on average (sine), and always in nearly the same direction, to determine its twist.
constexpr double kMinBend = 0.1;
constexpr double kMinCoherence = 0.8;
/// A limb whose rest pose bends less than this (sine) is straight at rest; bending is counted from there.
constexpr double kStraight = 0.2;

Vector3d SmplBone(int from, int to) { return (SmplRestJoints().row(to) - SmplRestJoints().row(from)).transpose(); }

/// Constant alignments A_j of the limbs of one side.
struct LimbAlignment {
  Matrix3d shoulder, elbow, wrist, hip, knee, ankle;
};

class Retargeter {
 public:
  Retargeter(const SkeletonMotion& source, const std::string& where)
      : source_(source), map_(MapSkeleton(source, where)), axes_(map_.file_from_body), rest_(RestPositions(source)) {
    double source_leg = 0, smpl_leg = 0;
    for (int side = 0; side < 2; ++side) {
      source_leg +=
          SourceBone(map_.hip[side], map_.knee[side]).norm() + SourceBone(map_.knee[side], map_.ankle[side]).norm();
      smpl_leg += SmplBone(kHip + side, kKnee + side).norm() + SmplBone(kKnee + side, kAnkle + side).norm();
    }
    if (!(source_leg > 0) || !std::isfinite(source_leg)) {
      throw std::runtime_error(where + ": the skeleton's legs have no length");
    }
    summary_.metres_per_unit = smpl_leg / source_leg;
    for (int side = 0; side < 2; ++side) Align(side);
  }

  Motion Run() {
    const int T = source_.num_frames();
    Motion motion;
    motion.body = "smpl";
    motion.up = Motion::Up::kY;
    motion.timestamps = source_.timestamps;
    motion.poses = RowMatrixXd::Zero(T, 72);
    motion.trans.resize(T, 3);
    for (int t = 0; t < T; ++t) {
      const SkeletonFrame frame = PoseSkeletonFrame(source_, t);
      const std::array<Matrix3d, 24> world = WorldRotations(frame);
      for (int j = 0; j < 24; ++j) {
        const int p = SmplParents()[j];
        const Matrix3d local = p < 0 ? world[j] : Matrix3d(world[p].transpose() * world[j]);
        motion.poses.block<1, 3>(t, 3 * j) = AxisAngleFromRotation(local).transpose();
      }
      const Vector3d mid_hip = 0.5 * (frame.positions.row(map_.hip[0]) + frame.positions.row(map_.hip[1])).transpose();
      const Vector3d smpl_mid_hip = 0.5 * (SmplRestJoints().row(kHip) + SmplRestJoints().row(kHip + 1)).transpose();
      motion.trans.row(t) =
          (summary_.metres_per_unit * (axes_.transpose() * mid_hip) - world[kPelvis] * smpl_mid_hip).transpose();
    }
    return motion;
  }

  [[nodiscard]] const RetargetSummary& summary() const { return summary_; }

 private:
  [[nodiscard]] Vector3d SourceBone(int from, int to) const { return (rest_.row(to) - rest_.row(from)).transpose(); }

  /// A · (turn of the SMPL bone onto the source's): the alignment of a joint from that of its parent.
  [[nodiscard]] Matrix3d Onto(const Matrix3d& parent, const Vector3d& smpl_bone, const Vector3d& source_bone) const {
    return RotationBetweenDirections(parent * smpl_bone, source_bone) * parent;
  }

  void Align(int side) {
    LimbAlignment& limb = limbs_[side];
    const Vector3d upper_arm = SmplBone(kShoulder + side, kElbow + side),
                   forearm = SmplBone(kElbow + side, kWrist + side);
    const Vector3d thigh = SmplBone(kHip + side, kKnee + side), shin = SmplBone(kKnee + side, kAnkle + side);
    const Vector3d source_upper_arm = SourceBone(map_.shoulder[side], map_.elbow[side]);
    const Vector3d source_forearm = SourceBone(map_.elbow[side], map_.wrist[side]);
    const Vector3d source_thigh = SourceBone(map_.hip[side], map_.knee[side]);
    const Vector3d source_shin = SourceBone(map_.knee[side], map_.ankle[side]);

    limb.shoulder = Onto(axes_, upper_arm, source_upper_arm);
    limb.wrist = Onto(limb.shoulder, forearm, source_forearm);
    limb.shoulder *= BendTwist({map_.shoulder[side], map_.elbow[side], map_.wrist[side]},
                               {kShoulder + side, kElbow + side, kWrist + side}, limb.shoulder,
                               Vector3d::UnitY() * (side == 0 ? -1 : 1), &summary_.shoulder_twist_deg[side]);
    limb.elbow = Onto(limb.shoulder, forearm, source_forearm);

    limb.hip = Onto(axes_, thigh, source_thigh);
    limb.hip *=
        BendTwist({map_.hip[side], map_.knee[side], map_.ankle[side]}, {kHip + side, kKnee + side, kAnkle + side},
                  limb.hip, Vector3d::UnitX(), &summary_.hip_twist_deg[side]);
    limb.knee = Onto(limb.hip, shin, source_shin);

    // The foot's heading, in SMPL's frame of the shin: a turn about the vertical.
    const Vector3d foot = SmplBone(kAnkle + side, kToe + side);
    const Vector3d source_foot = map_.toe[side] >= 0 ? SourceBone(map_.ankle[side], map_.toe[side]) : Vector3d::Zero();
    const Vector3d goal = limb.knee.transpose() * (source_foot.norm() > 0 ? source_foot : Vector3d(axes_.col(2)));
    const double turn = std::atan2(goal.x(), goal.z()) - std::atan2(foot.x(), foot.z());
    limb.ankle = limb.knee * RotationFromAxisAngle(Vector3d::UnitY() * turn);
  }

  /// The rotation about the upper bone after which the lower one bends about SMPL's natural hinge (an axis of SMPL's
  /// rest frame), from the sum of bends over the clip against that of SMPL's limb bent by the same angles; identity if
  /// the limb hardly bends or has no consistent direction of bending.
  [[nodiscard]] Matrix3d BendTwist(const std::array<int, 3>& source, const std::array<int, 3>& smpl,
                                   const Matrix3d& alignment, const Vector3d& hinge, double* twist_deg) const {
    const Vector3d axis = SmplBone(smpl[0], smpl[1]).normalized(), lower = SmplBone(smpl[1], smpl[2]).normalized();
    const auto across = [&](const Vector3d& v) -> Vector3d { return v - v.dot(axis) * axis; };
    // Direction of the lower bone of a straight limb: its rest direction (legs deviate sideways at the knee by a few
    // degrees without bending), or the upper bone's if the source rests with bent limbs.
    const Vector3d at_rest = alignment.transpose() * SourceBone(source[1], source[2]).normalized();
    const bool is_straight = across(at_rest).norm() < kStraight;
    const Vector3d straight = is_straight ? at_rest : axis;
    Vector3d sum = Vector3d::Zero(), expected = Vector3d::Zero();
    double weight = 0;
    for (int t = 0; t < source_.num_frames(); ++t) {
      const SkeletonFrame frame = PoseSkeletonFrame(source_, t);
      const Vector3d bone = (frame.positions.row(source[2]) - frame.positions.row(source[1])).transpose().normalized();
      const Vector3d direction = alignment.transpose() * (frame.rotations[source[0]].transpose() * bone);
      const double angle = std::atan2(direction.cross(straight).norm(), direction.dot(straight));
      const Vector3d bend = across(direction - straight);
      sum += bend;
      expected += across(RotationFromAxisAngle(hinge * angle) * lower - (is_straight ? lower : axis));
      weight += bend.norm();
    }
    if (weight < kMinBend * source_.num_frames() || sum.norm() < kMinCoherence * weight) return Matrix3d::Identity();
    const double twist = std::atan2(axis.dot(sum.cross(expected)), sum.dot(expected));
    *twist_deg = twist * 180 / M_PI;
    // Rotates the limb so that the source's bending agrees with SMPL's hinge: A ← A·exp(−twist·axis).
    return RotationFromAxisAngle(axis * -twist);
  }

  /// Rotation at a fraction (0 to 1) of a chain that starts below joint `base`.
  [[nodiscard]] Matrix3d AlongChain(const SkeletonFrame& frame, int base, const std::vector<int>& chain,
                                    double fraction) const {
    const double at = fraction * static_cast<double>(chain.size());
    const auto low = static_cast<size_t>(at);
    const Matrix3d& below = low == 0 ? frame.rotations[base] : frame.rotations[chain[low - 1]];
    if (low >= chain.size()) return below;
    return InterpolateRotation(below, frame.rotations[chain[low]], at - static_cast<double>(low));
  }

  [[nodiscard]] std::array<Matrix3d, 24> WorldRotations(const SkeletonFrame& frame) const {
    std::array<Matrix3d, 24> world;
    const auto follow = [&](const Matrix3d& source, const Matrix3d& alignment) -> Matrix3d {
      return axes_.transpose() * source * alignment;
    };
    const int chest = map_.spine.empty() ? map_.pelvis : map_.spine.back();
    world[kPelvis] = follow(frame.rotations[map_.pelvis], axes_);
    world[kSpine1] = follow(AlongChain(frame, map_.pelvis, map_.spine, 1.0 / 3), axes_);
    world[kSpine2] = follow(AlongChain(frame, map_.pelvis, map_.spine, 2.0 / 3), axes_);
    world[kSpine3] = follow(frame.rotations[chest], axes_);
    world[kNeck] = follow(AlongChain(frame, chest, map_.neck, 0.5), axes_);
    world[kHead] = follow(frame.rotations[map_.neck.back()], axes_);
    for (int side = 0; side < 2; ++side) {
      const LimbAlignment& limb = limbs_[side];
      world[kHip + side] = follow(frame.rotations[map_.hip[side]], limb.hip);
      world[kKnee + side] = follow(frame.rotations[map_.knee[side]], limb.knee);
      world[kAnkle + side] = follow(frame.rotations[map_.ankle[side]], limb.ankle);
      const int toe = map_.toe[side] >= 0 ? map_.toe[side] : map_.ankle[side];
      world[kToe + side] = follow(frame.rotations[toe], limb.ankle);
      const int collar = map_.collar[side] >= 0 ? map_.collar[side] : chest;
      world[kCollar + side] = follow(frame.rotations[collar], axes_);
      world[kShoulder + side] = follow(frame.rotations[map_.shoulder[side]], limb.shoulder);
      world[kElbow + side] = follow(frame.rotations[map_.elbow[side]], limb.elbow);
      world[kWrist + side] = follow(frame.rotations[map_.palm[side]], limb.wrist);
      ShareTwist(side, &world[kElbow + side], world[kWrist + side]);
      world[kWrist + 2 + side] = world[kWrist + side];
    }
    return world;
  }

  /// Turns the forearm by ½ sin(τ), τ the hand's twist about it: half of a small twist, and continuous where τ jumps
  /// from 180° to −180° (as with noisy wrists).
  static void ShareTwist(int side, Matrix3d* forearm, const Matrix3d& hand) {
    const Vector3d axis = SmplBone(kElbow + side, kWrist + side).normalized();
    const Eigen::Quaterniond relative(forearm->transpose() * hand);
    const double twist = 2 * std::atan2(relative.vec().dot(axis), relative.w());
    *forearm *= RotationFromAxisAngle(axis * (0.5 * std::sin(twist)));
  }

  const SkeletonMotion& source_;
  SkeletonMap map_;
  Matrix3d axes_;
  MatrixX3d rest_;
  std::array<LimbAlignment, 2> limbs_;
  RetargetSummary summary_;
};

/// SMPL's 24 names among the source's joints, or an empty list when one is missing.
std::vector<int> SmplJointsOf(const SkeletonMotion& source) {
  std::vector<int> joints;
  for (const std::string& name : SmplJointNames()) {
    joints.push_back(source.FindJoint(name));
    if (joints.back() < 0) return {};
  }
  return joints;
}

Motion CopySmpl(const SkeletonMotion& source, const std::vector<int>& joints, const std::string& where,
                RetargetSummary* summary) {
  const MatrixX3d rest = RestPositions(source);
  double source_leg = 0, smpl_leg = 0;
  for (int side = 0; side < 2; ++side) {
    const int hip = joints[kHip + side], knee = joints[kKnee + side], ankle = joints[kAnkle + side];
    source_leg += (rest.row(knee) - rest.row(hip)).norm() + (rest.row(ankle) - rest.row(knee)).norm();
    smpl_leg += SmplBone(kHip + side, kKnee + side).norm() + SmplBone(kKnee + side, kAnkle + side).norm();
  }
  if (!(source_leg > 0)) throw std::runtime_error(where + ": the skeleton's legs have no length");
  summary->metres_per_unit = smpl_leg / source_leg;
  Motion motion;
  motion.body = "smpl";
  motion.timestamps = source.timestamps;
  motion.poses.resize(source.num_frames(), 72);
  motion.trans = source.root_positions * summary->metres_per_unit;
  for (int t = 0; t < source.num_frames(); ++t) {
    for (int j = 0; j < 24; ++j) {
      motion.poses.block<1, 3>(t, 3 * j) =
          AxisAngleFromRotation(source.rotations[size_t(t) * source.num_joints() + joints[j]]).transpose();
    }
  }
  return motion;
}

}  // namespace

Motion RetargetToSmpl(const SkeletonMotion& source, const std::string& where, RetargetSummary* summary) {
  RetargetSummary unused;
  if (summary == nullptr) summary = &unused;
  if (const std::vector<int> joints = SmplJointsOf(source); !joints.empty()) {
    return CopySmpl(source, joints, where, summary);
  }
  Retargeter retargeter(source, where);
  Motion motion = retargeter.Run();
  *summary = retargeter.summary();
  return motion;
}

}  // namespace bodyloom
