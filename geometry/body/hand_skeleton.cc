// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/hand_skeleton.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {

using Eigen::Vector3d;

namespace {

constexpr int kThumb = 4;  // in FingerNames()

std::array<std::string, kHandJoints> JointNamesOfHand(const std::string& prefix) {
  std::array<std::string, kHandJoints> names;
  for (int i = 0; i < kHandJoints; ++i) names[i] = prefix + FingerNames()[i / 3] + std::to_string(i % 3 + 1);
  return names;
}

std::array<std::string, kHandPoints> LandmarkNamesOfHand(const std::string& prefix) {
  std::array<std::string, kHandPoints> names = {prefix + "wrist"};
  int i = 1;
  for (const char* finger : {"thumb", "index", "middle", "ring", "pinky"}) {
    const bool thumb = i == 1;
    for (const char* joint : {thumb ? "cmc" : "mcp", thumb ? "mcp" : "pip", thumb ? "ip" : "dip", "tip"}) {
      names[i++] = prefix + finger + "_" + joint;
    }
  }
  return names;
}

std::vector<std::pair<int, int>> MakeHandBones() {
  std::vector<std::pair<int, int>> bones;
  for (int finger = 0; finger < 5; ++finger) {
    const int first = 1 + 4 * finger;
    bones.emplace_back(0, first);
    for (int k = first; k < first + 3; ++k) bones.emplace_back(k, k + 1);
  }
  return bones;
}

/// The joint of a body's hand at landmark i, as an index into HandJointNames(); −1 for the wrist and tips.
int JointOfLandmark(int i) {
  constexpr std::array<int, 5> kFinger = {kThumb, 0, 1, 3, 2};
  return i == 0 || i % 4 == 0 ? -1 : 3 * kFinger[(i - 1) / 4] + (i - 1) % 4;
}

}  // namespace

const std::array<std::string, 5>& FingerNames() {
  static const std::array<std::string, 5> names = {"index", "middle", "pinky", "ring", "thumb"};
  return names;
}

const std::array<std::string, kHandJoints>& HandJointNames(HandSide side) {
  static const std::array<std::string, kHandJoints> left = JointNamesOfHand("l_"), right = JointNamesOfHand("r_");
  return side == HandSide::kLeft ? left : right;
}

const std::array<std::string, kHandPoints>& HandLandmarkNames(HandSide side) {
  static const std::array<std::string, kHandPoints> left = LandmarkNamesOfHand("left_"),
                                                    right = LandmarkNamesOfHand("right_");
  return side == HandSide::kLeft ? left : right;
}

std::span<const std::pair<int, int>> HandBones() {
  static const std::vector<std::pair<int, int>> bones = MakeHandBones();
  return bones;
}

std::vector<Landmark> HandLandmarks(const BodyModelData& body, HandSide side, const std::array<int, 5>& tip_vertices) {
  std::vector<Landmark> landmarks;
  for (int i = 1; i < kHandPoints; ++i) {
    Landmark landmark{HandLandmarkNames(side)[i], {}, {}};
    if (const int joint = JointOfLandmark(i); joint < 0) {
      landmark.vertices = {tip_vertices[i / 4 - 1]};
      landmark.weights = {1};
    } else {
      const std::string& name = HandJointNames(side)[joint];
      const auto found = std::find(body.joint_names.begin(), body.joint_names.end(), name);
      BODYLOOM_CHECK(found != body.joint_names.end(), "hand landmarks: the body '", body.name, "' has no joint '", name,
                     "'");
      double sum = 0;
      for (SparseRows::InnerIterator it(body.J_regressor, found - body.joint_names.begin()); it; ++it) {
        landmark.vertices.push_back(static_cast<int>(it.col()));
        landmark.weights.push_back(it.value());
        sum += it.value();
      }
      for (double& weight : landmark.weights) weight /= sum;
    }
    landmarks.push_back(std::move(landmark));
  }
  return landmarks;
}

std::optional<HandSkeleton> FindHand(const BodyModel& body, HandSide side) {
  const bool left = side == HandSide::kLeft;
  HandSkeleton hand;
  hand.side = side;
  hand.wrist = body.FindJoint(left ? "l_wrist" : "r_wrist");
  if (hand.wrist < 0) return std::nullopt;
  std::array<Vector3d, kHandJoints> at;
  for (int i = 0; i < kHandJoints; ++i) {
    hand.joint[i] = body.FindJoint(HandJointNames(side)[i]);
    if (hand.joint[i] < 0) return std::nullopt;
    at[i] = body.joint_template().row(hand.joint[i]);
  }
  const Vector3d wrist = body.joint_template().row(hand.wrist);
  const auto first = [&](int finger) { return at[3 * finger]; };
  const Vector3d dorsal = (left ? 1 : -1) * (first(0) - wrist).cross(first(2) - wrist).normalized();
  const Vector3d below = first(2) - 0.25 * (first(1) - wrist).norm() * dorsal;
  Vector3d bone_before = Vector3d::Zero();
  for (int i = 0; i < kHandJoints; ++i) {
    const int finger = i / 3;
    Vector3d next = 2 * at[i] - at[std::max(i - 1, 0)];  // as the bone before it
    if (i % 3 < 2) {
      next = at[i + 1];
    } else {
      constexpr std::array<int, 5> kTip = {8, 12, 20, 16, 4};
      if (const int tip = body.FindLandmark(HandLandmarkNames(side)[kTip[finger]]); tip >= 0) {
        const Landmark& landmark = body.data().landmarks[tip];
        next.setZero();
        for (size_t k = 0; k < landmark.vertices.size(); ++k) {
          next += landmark.weights[k] * body.data().v_template.row(landmark.vertices[k]).transpose();
        }
      }
    }
    const Vector3d bone = (next - at[i]).normalized();
    const Vector3d back = finger == kThumb ? Vector3d(at[3 * kThumb + 1] - below) : dorsal;
    const Vector3d flexion = back.cross(bone).normalized();
    if (i % 3 == 0) {
      hand.rest_flexion[i] = finger == kThumb ? 0 : std::asin(-dorsal.dot(bone));
    } else {
      hand.rest_flexion[i] = std::asin(std::clamp(bone_before.cross(bone).dot(flexion), -1.0, 1.0));
    }
    bone_before = bone;
    hand.axes[i] << flexion, (left ? 1 : -1) * flexion.cross(bone), (left ? 1 : -1) * bone;
  }
  return hand;
}

bool HasFingers(const BodyModel& body) {
  const auto has = [&](const std::string& name) { return body.FindJoint(name) >= 0; };
  const auto& left = HandJointNames(HandSide::kLeft);
  const auto& right = HandJointNames(HandSide::kRight);
  return std::all_of(left.begin(), left.end(), has) && std::all_of(right.begin(), right.end(), has);
}

}  // namespace bodyloom
