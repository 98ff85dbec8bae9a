// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/retarget.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "data_tools/formats/printable.h"
#include "data_tools/motion/smpl_rest.h"
#include "geometry/body/body_model.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Tokens = std::vector<std::string>;

/// "mixamorig:LeftForeArm" → "leftforearm".
std::string PlainName(const std::string& name) {
  std::string plain;
  const size_t colon = name.rfind(':');
  for (const char c : name.substr(colon == std::string::npos ? 0 : colon + 1)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) plain += static_cast<char>(std::tolower(c));
  }
  for (const char* prefix : {"mixamorig", "bip01", "bip001"}) {
    if (plain.starts_with(prefix)) return plain.substr(std::string(prefix).size());
  }
  return plain;
}

class Finder {
 public:
  Finder(const SkeletonMotion& motion, std::string where) : motion_(motion), where_(std::move(where)) {
    for (const std::string& name : motion.names) names_.push_back(PlainName(name));
  }

  /// The first joint called by one of the tokens (in their order) on that side; −1 when there is none.
  [[nodiscard]] int Find(int side, const Tokens& tokens) const {
    const std::string full = side == 0 ? "left" : "right", letter = side == 0 ? "l" : "r";
    for (const std::string& token : tokens) {
      for (const std::string& name : {full + token, letter + token, token + full, token + letter}) {
        const auto found = std::find(names_.begin(), names_.end(), name);
        if (found != names_.end()) return static_cast<int>(found - names_.begin());
      }
    }
    return -1;
  }
  [[nodiscard]] int Require(int side, const Tokens& tokens) const {
    const int joint = Find(side, tokens);
    if (joint < 0) Fail(std::string("no ") + (side == 0 ? "left " : "right ") + tokens[0]);
    return joint;
  }
  [[nodiscard]] int FindMiddle(const Tokens& tokens) const {
    for (const std::string& token : tokens) {
      const auto found = std::find(names_.begin(), names_.end(), token);
      if (found != names_.end()) return static_cast<int>(found - names_.begin());
    }
    return -1;
  }
  [[nodiscard]] int Parent(int joint, const std::string& what) const {
    if (motion_.parents[joint] < 0)
      Fail("'" + PrintableText(motion_.names[joint]) + "' is the root, expected " + what + " above it");
    return motion_.parents[joint];
  }
  /// Joints from `joint` up to the root, both included.
  [[nodiscard]] std::vector<int> Upwards(int joint) const {
    std::vector<int> path;
    for (int j = joint; j >= 0; j = motion_.parents[j]) path.push_back(j);
    return path;
  }
  [[nodiscard]] int CommonAncestor(int a, int b) const {
    const std::vector<int> path = Upwards(a);
    for (const int j : Upwards(b)) {
      if (std::find(path.begin(), path.end(), j) != path.end()) return j;
    }
    return 0;
  }
  /// From below `top` down to `bottom`; `top` must be an ancestor of `bottom` or itself.
  [[nodiscard]] std::vector<int> Chain(int top, int bottom) const {
    std::vector<int> chain;
    for (int j = bottom; j >= 0 && j != top; j = motion_.parents[j]) chain.push_back(j);
    std::reverse(chain.begin(), chain.end());
    return chain;
  }
  [[nodiscard]] bool IsBelow(int joint, int ancestor) const {
    const std::vector<int> path = Upwards(joint);
    return joint != ancestor && std::find(path.begin(), path.end(), ancestor) != path.end();
  }
  [[noreturn]] void Fail(const std::string& message) const {
    throw std::runtime_error(where_ + ": the skeleton is not recognised as a person's: " + message +
                             "; its joints are " + PrintableList(motion_.names));
  }

 private:
  const SkeletonMotion& motion_;
  std::string where_;
  std::vector<std::string> names_;
};

/// The signed axis nearest to v.
Eigen::Vector3d NearestAxis(const Eigen::Vector3d& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return Eigen::Vector3d::Unit(axis) * (v[axis] < 0 ? -1 : 1);
}

Eigen::Matrix3d BodyAxes(const SkeletonMotion& motion, const SkeletonMap& map, const Finder& finder) {
  const MatrixX3d rest = RestPositions(motion);
  const auto at = [&](int j) -> Eigen::Vector3d { return rest.row(j); };
  const Eigen::Vector3d mid_hip = 0.5 * (at(map.hip[0]) + at(map.hip[1]));
  const Eigen::Vector3d shoulders = 0.5 * (at(map.shoulder[0]) + at(map.shoulder[1]));
  const Eigen::Vector3d knees = 0.5 * (at(map.knee[0]) + at(map.knee[1]));
  const Eigen::Vector3d up = NearestAxis(shoulders - knees);
  Eigen::Vector3d left = at(map.hip[0]) - at(map.hip[1]);
  if (!(left.norm() > 0)) left = at(map.shoulder[0]) - at(map.shoulder[1]);
  left -= left.dot(up) * up;
  if (!(left.norm() > 0) || !((shoulders - knees).norm() > 0) || !((mid_hip - knees).norm() > 0)) {
    finder.Fail("the rest pose has no left, up or leg length");
  }
  Eigen::Matrix3d axes;
  axes.col(0) = NearestAxis(left);
  axes.col(1) = up;
  axes.col(2) = axes.col(0).cross(up);
  return axes;
}

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

SkeletonMap MapSkeleton(const SkeletonMotion& motion, const std::string& where) {
  const Finder finder(motion, where);
  SkeletonMap map;
  for (int side = 0; side < 2; ++side) {
    map.knee[side] = finder.Require(side, {"knee", "leg", "lowerleg", "lowleg", "tibia", "shin", "calf"});
    map.ankle[side] = finder.Require(side, {"ankle", "foot"});
    map.toe[side] = finder.Find(side, {"toebase", "toe", "toes", "ball", "foot"});
    if (map.toe[side] == map.ankle[side]) map.toe[side] = -1;
    map.elbow[side] = finder.Require(side, {"elbow", "forearm", "lowerarm", "lowarm", "radius"});
    map.wrist[side] = finder.Require(side, {"wrist", "hand"});
    map.palm[side] = finder.Find(side, {"fingerbase", "hand", "palm"});
    if (map.palm[side] < 0 || !finder.IsBelow(map.palm[side], map.wrist[side])) map.palm[side] = map.wrist[side];
    map.hip[side] = finder.Parent(map.knee[side], "a hip");
    map.shoulder[side] = finder.Parent(map.elbow[side], "a shoulder");
    const bool is_leg = finder.IsBelow(map.ankle[side], map.knee[side]);
    if (!is_leg || !finder.IsBelow(map.wrist[side], map.elbow[side])) finder.Fail("the limbs are not chains");
  }
  map.pelvis = finder.CommonAncestor(map.hip[0], map.hip[1]);
  const int chest = finder.CommonAncestor(map.shoulder[0], map.shoulder[1]);
  map.spine = finder.Chain(finder.CommonAncestor(map.pelvis, chest), chest);
  for (int side = 0; side < 2; ++side) {
    const std::vector<int> arm = finder.Chain(chest, map.shoulder[side]);
    if (arm.size() >= 2) map.collar[side] = arm[arm.size() - 2];
  }
  const int head = finder.FindMiddle({"head", "neck1", "neck"});
  if (head < 0 || !finder.IsBelow(head, chest)) finder.Fail("no head above the chest");
  map.neck = finder.Chain(chest, head);
  map.file_from_body = BodyAxes(motion, map, finder);
  return map;
}

}  // namespace bodyloom
