// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body_making/makehuman_tpose.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>

#include "bodyloom/geometry/base/units.h"
#include "bodyloom/geometry/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kClavicleRaise = 10 * kDegree;
constexpr double kFootYaw = 7 * kDegree;

Vector3d MeanOf(const MatrixX3d& vertices, const std::vector<int>& indices) {
  Vector3d sum = Vector3d::Zero();
  for (int i : indices) sum += vertices.row(i).transpose();
  return sum / static_cast<double>(indices.size());
}

/// The rotation that takes direction a to x, and b, as far as it is perpendicular to a, to y.
Matrix3d FrameOf(const Vector3d& a, const Vector3d& b) {
  Matrix3d frame;
  frame.row(0) = a.normalized();
  frame.row(1) = (b - b.dot(frame.row(0)) * frame.row(0).transpose()).normalized();
  frame.row(2) = frame.row(0).cross(frame.row(1));
  return frame;
}

/// The rotation that takes (a, b) to (x, y) as above, then to (to_a, to_b).
Matrix3d Align(const Vector3d& a, const Vector3d& b, const Vector3d& to_a, const Vector3d& to_b) {
  return FrameOf(to_a, to_b).transpose() * FrameOf(a, b);
}

/// World rotations and new heads of all bones.
class Poser {
 public:
  Poser(const MakeHumanFiles& files, const MatrixX3d& vertices_dm)
      : files_(files), vertices_(vertices_dm), rotations_(files.bones.size(), Matrix3d::Identity()) {
    for (const MakeHumanBone& bone : files.bones) {
      heads_.push_back(MeanOf(vertices_, bone.head_vertices));
      tails_.push_back(MeanOf(vertices_, bone.tail_vertices));
    }
    new_heads_ = heads_;
  }

  void Solve() {
    for (int side : {1, -1}) {
      const std::string suffix = side == 1 ? "_l" : "_r";
      PoseArm(side, suffix);
      PoseLeg(side, suffix);
    }
    // Bones that nothing turned keep to their parent (finger tips, thumbs, toes); parents come first.
    for (size_t b = 0; b < files_.bones.size(); ++b) {
      const int parent = files_.bones[b].parent;
      if (parent < 0) continue;
      if (!is_set_.contains(static_cast<int>(b))) rotations_[b] = rotations_[parent];
      new_heads_[b] = rotations_[parent] * (heads_[b] - heads_[parent]) + new_heads_[parent];
    }
  }

  [[nodiscard]] Vector3d Move(int bone, const Vector3d& point) const {
    return rotations_[bone] * (point - heads_[bone]) + new_heads_[bone];
  }

  [[nodiscard]] int Bone(const std::string& name) const {
    const int bone = files_.FindBone(name);
    if (bone < 0) throw std::runtime_error("rig.game_engine.json: no bone '" + name + "', which the T-pose needs");
    return bone;
  }

  /// Centre of a joint cube at rest.
  [[nodiscard]] Vector3d Cube(const std::string& name) const {
    const auto cube = files_.joint_cubes.find("joint-" + name);
    if (cube == files_.joint_cubes.end()) {
      throw std::runtime_error("base.obj: no joint cube 'joint-" + name + "', which the 24 joints need");
    }
    return MeanOf(vertices_, cube->second);
  }

 private:
  [[nodiscard]] Vector3d Direction(int bone) const { return (tails_[bone] - heads_[bone]).normalized(); }

  void Set(int bone, const Matrix3d& rotation) {
    rotations_[bone] = rotation;
    is_set_.insert(bone);
  }

  void PoseArm(int side, const std::string& suffix) {
    const Vector3d out(side, 0, 0), front(0, 0, 1), up(0, 1, 0);
    Set(Bone("clavicle" + suffix), RotationFromAxisAngle({0, 0, side * kClavicleRaise}));
    // At rest the elbow is slightly bent, which shows its axis: upper × lower arm, downwards on the left in T-pose.
    const int upper = Bone("upperarm" + suffix), lower = Bone("lowerarm" + suffix), hand = Bone("hand" + suffix);
    const Vector3d axis = Direction(upper).cross(Direction(lower));
    const Vector3d axis_in_t_pose = out.cross(front);
    Set(upper, Align(Direction(upper), axis, out, axis_in_t_pose));
    Set(lower, Align(Direction(lower), axis, out, axis_in_t_pose));
    const std::array<std::string, 4> fingers = {"index", "middle", "ring", "pinky"};
    const std::array<double, 4> spread = {7 * kDegree, 1 * kDegree, -5 * kDegree, -12 * kDegree};
    const std::array<double, 3> curl = {4 * kDegree, 12 * kDegree, 16 * kDegree};
    const Vector3d knuckles =
        0.5 * (heads_[Bone("middle_01" + suffix)] + heads_[Bone("ring_01" + suffix)]) - heads_[hand];
    const Vector3d across = heads_[Bone("index_01" + suffix)] - heads_[Bone("pinky_01" + suffix)];
    Set(hand, Align(knuckles, across, out, front));
    for (size_t finger = 0; finger < fingers.size(); ++finger) {
      for (int phalanx = 0; phalanx < 3; ++phalanx) {
        const int bone = Bone(fingers[finger] + "_0" + std::to_string(phalanx + 1) + suffix);
        const double s = spread[finger], c = curl[phalanx];
        const Vector3d direction = std::cos(c) * (std::cos(s) * out + std::sin(s) * front) - std::sin(c) * up;
        const Vector3d turned = rotations_[hand] * Direction(bone);
        Set(bone, RotationBetweenDirections(turned, direction) * rotations_[hand]);
      }
    }
  }

  void PoseLeg(int side, const std::string& suffix) {
    const int thigh = Bone("thigh" + suffix), calf = Bone("calf" + suffix), foot = Bone("foot" + suffix);
    Set(thigh, RotationBetweenDirections(Direction(thigh), Vector3d(side * .045, -1, -.02)));
    Set(calf, RotationBetweenDirections(Direction(calf), Vector3d(side * .035, -1, -.03)));
    const Vector3d direction = Direction(foot);
    const double yaw = std::atan2(direction.x(), direction.z());
    Set(foot, RotationFromAxisAngle({0, side * kFootYaw - yaw, 0}));
  }

  const MakeHumanFiles& files_;
  const MatrixX3d& vertices_;
  std::vector<Matrix3d> rotations_;
  std::vector<Vector3d> heads_, tails_, new_heads_;
  std::set<int> is_set_;
};

/// SMPL's joints in the T-pose, in the units of the mesh.
MatrixX3d FindJoints(const Poser& poser, double metre) {
  MatrixX3d joints(24, 3);
  const auto set = [&](int joint, const Vector3d& point) { joints.row(joint) = point.transpose(); };
  const Vector3d hips = 0.5 * (poser.Cube("l-upper-leg") + poser.Cube("r-upper-leg"));
  set(0, hips + 0.8 * (poser.Cube("spine-4") - hips));
  set(3, 0.62 * poser.Cube("spine-3") + 0.38 * poser.Cube("spine-2"));
  set(6, 0.42 * poser.Cube("spine-2") + 0.58 * poser.Cube("spine-1"));
  set(9, poser.Cube("spine-1"));
  set(12, poser.Cube("neck"));
  set(15, poser.Cube("head"));
  for (int right = 0; right < 2; ++right) {
    const std::string side = right ? "r-" : "l-", suffix = right ? "_r" : "_l";
    const Vector3d hip = poser.Cube(side + "upper-leg");
    set(1 + right, {0.75 * hip.x(), hip.y() - 0.004 * metre, hip.z()});
    set(4 + right, poser.Move(poser.Bone("thigh" + suffix), poser.Cube(side + "knee")));
    set(7 + right, poser.Move(poser.Bone("calf" + suffix), poser.Cube(side + "ankle")));
    set(10 + right, poser.Move(poser.Bone("foot" + suffix), poser.Cube(side + "foot-1")));
    const int clavicle = poser.Bone("clavicle" + suffix);
    const Vector3d shoulder = poser.Move(clavicle, poser.Cube(side + "shoulder"));
    set(13 + right,
        0.58 * poser.Move(clavicle, poser.Cube(side + "clavicle")) + 0.42 * shoulder - Vector3d(0, 0.012 * metre, 0));
    set(16 + right, shoulder);
    set(18 + right, poser.Move(poser.Bone("upperarm" + suffix), poser.Cube(side + "elbow")));
    set(20 + right, poser.Move(poser.Bone("lowerarm" + suffix), poser.Cube(side + "hand")));
    // Between the knuckles of the middle and ring fingers lies the web: a tenth of the way back is inside the hand.
    const Vector3d knuckles = 0.5 * (poser.Cube(side + "finger-3-1") + poser.Cube(side + "finger-4-1"));
    set(22 + right, poser.Move(poser.Bone("hand" + suffix), 0.9 * knuckles + 0.1 * poser.Cube(side + "hand")));
  }
  return joints;
}

}  // namespace

MakeHumanTPose PoseMakeHuman(const MakeHumanFiles& files, const MatrixX3d& vertices_dm, double metres_per_unit) {
  Poser poser(files, vertices_dm);
  poser.Solve();
  MakeHumanTPose result;
  result.joints = FindJoints(poser, 1 / metres_per_unit);
  result.vertices.setZero(files.num_body_vertices, 3);
  for (int v = 0; v < files.num_body_vertices; ++v) {
    const Vector3d rest = vertices_dm.row(v);
    for (SparseRows::InnerIterator it(files.bone_weights, v); it; ++it) {
      result.vertices.row(v) += it.value() * poser.Move(static_cast<int>(it.col()), rest).transpose();
    }
  }
  const Eigen::RowVector3d pelvis = result.joints.row(0);
  result.vertices = (metres_per_unit * (result.vertices.rowwise() - pelvis)).eval();
  result.joints = (metres_per_unit * (result.joints.rowwise() - pelvis)).eval();
  return result;
}

}  // namespace bodyloom
