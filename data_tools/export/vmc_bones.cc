// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/vmc_bones.h"

#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Names in Unity and here, in the order of the hierarchy.
std::vector<std::pair<std::string, std::string>> BoneNames() {
  std::vector<std::pair<std::string, std::string>> names = {{"Hips", "pelvis"},  {"Spine", "spine1"},
                                                            {"Chest", "spine2"}, {"UpperChest", "spine3"},
                                                            {"Neck", "neck"},    {"Head", "head"}};
  for (const auto& [unity, own] : {std::pair{std::string("Left"), std::string("l_")}, {"Right", "r_"}}) {
    for (const auto& [bone, joint] : {std::pair{"UpperLeg", "hip"},
                                      {"LowerLeg", "knee"},
                                      {"Foot", "ankle"},
                                      {"Toes", "foot"},
                                      {"Shoulder", "collar"},
                                      {"UpperArm", "shoulder"},
                                      {"LowerArm", "elbow"},
                                      {"Hand", "wrist"}}) {
      names.emplace_back(unity + bone, own + joint);
    }
    for (const auto& [finger, joint] : {std::pair{"Thumb", "thumb"},
                                        {"Index", "index"},
                                        {"Middle", "middle"},
                                        {"Ring", "ring"},
                                        {"Little", "pinky"}}) {
      names.emplace_back(unity + finger + "Proximal", own + joint + "1");
      names.emplace_back(unity + finger + "Intermediate", own + joint + "2");
      names.emplace_back(unity + finger + "Distal", own + joint + "3");
    }
  }
  return names;
}

}  // namespace

Eigen::Vector3d UnityPosition(const Eigen::Vector3d& point) { return {-point.x(), point.y(), point.z()}; }

Eigen::Quaterniond UnityRotation(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond own(rotation);
  const double sign = own.w() < 0 ? -1 : 1;
  return {sign * own.w(), sign * own.x(), -sign * own.y(), -sign * own.z()};
}

std::vector<VmcBone> VmcBones(const BodyModel& body, const MatrixX3d& rest_joints, const BodyPose& pose,
                              const Eigen::Vector3d& origin) {
  const int J = body.num_joints();
  BODYLOOM_CHECK(rest_joints.rows() == J && int(pose.rotations.size()) == J, "VMC bones: ", rest_joints.rows(),
                 " rest joints and ", pose.rotations.size(), " rotations, expected ", J, " of each");
  static const std::vector<std::pair<std::string, std::string>> names = BoneNames();
  std::vector<VmcBone> bones;
  for (const auto& [name, joint] : names) {
    const int j = body.FindJoint(joint);
    if (j < 0) continue;
    const int parent = body.parents()[size_t(j)];
    const Eigen::Vector3d rest = rest_joints.row(j).transpose();
    const Eigen::Vector3d place = parent < 0 ? Eigen::Vector3d(rest + pose.trans - origin)
                                             : Eigen::Vector3d(rest - rest_joints.row(parent).transpose());
    bones.push_back({name, UnityPosition(place), UnityRotation(pose.rotations[size_t(j)])});
  }
  return bones;
}

}  // namespace bodyloom
