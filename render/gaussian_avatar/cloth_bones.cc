// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/cloth_bones.h"

#include <algorithm>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using RowMatrix34f = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

/// Composes a bone with the rigid motion (R, t).
RowMatrix34f TakenOn(const Eigen::Matrix3f& R, const Eigen::Vector3f& t, const RowMatrix34f& bone) {
  RowMatrix34f on = R * bone;
  on.col(3) += t;
  return on;
}

void Append(const RowMatrix34f& bone, std::vector<float>* bones) {
  bones->insert(bones->end(), bone.data(), bone.data() + bone.size());
}

RowMatrix34f BoneAt(const float* bones, Eigen::Index k) { return Eigen::Map<const RowMatrix34f>(bones + 12 * k); }

}  // namespace

std::vector<float> BonesOfCloth(const ClothNodes& nodes, const MovedNodes& moved) {
  std::vector<float> bones;
  bones.reserve(12 * static_cast<size_t>(nodes.size()));
  for (int k = 0; k < nodes.size(); ++k) {
    RowMatrix34f bone;
    bone.leftCols<3>() = moved.rotations[k].cast<float>();
    bone.col(3) =
        (moved.places.row(k).transpose() - moved.rotations[k] * nodes.places().row(k).transpose()).cast<float>();
    Append(bone, &bones);
  }
  return bones;
}

std::vector<float> SeenBones(std::span<const float> bones, const CameraPose& camera) {
  BODYLOOM_CHECK(bones.size() % 12 == 0, "bones of cloth: ", bones.size(), " numbers, expected a multiple of 12");
  const Eigen::Matrix3f R = camera.camera_from_world_rotation.cast<float>();
  const Eigen::Vector3f t = camera.camera_from_world_translation.cast<float>();
  std::vector<float> seen;
  seen.reserve(bones.size());
  for (size_t k = 0; k < bones.size() / 12; ++k) Append(TakenOn(R, t, BoneAt(bones.data(), k)), &seen);
  return seen;
}

void ReplaceLastBones(std::span<const float> seen, AvatarFrame* frame) {
  BODYLOOM_CHECK(seen.size() <= frame->bones.size(), "bones of cloth: ", seen.size(), " numbers for the place of ",
                 frame->bones.size());
  std::copy(seen.begin(), seen.end(), frame->bones.end() - static_cast<std::ptrdiff_t>(seen.size()));
}

void AppendBones(std::span<const float> bones, const MatrixX3d& as_sewn, const CameraPose& camera, AvatarFrame* frame) {
  const Eigen::Index count = as_sewn.rows(), joints = frame->rest_joints.rows();
  BODYLOOM_CHECK(bones.size() == 12 * static_cast<size_t>(count), "bones of cloth: ", bones.size(),
                 " numbers, expected ", 12 * count);
  const std::vector<float> seen = SeenBones(bones, camera);
  frame->bones.insert(frame->bones.end(), seen.begin(), seen.end());
  frame->rest_joints.conservativeResize(joints + count, 3);
  frame->rest_joints.bottomRows(count) = as_sewn.cast<float>();
}

void CarryBones(const AvatarFrame& frame, AvatarFrame* corrected) {
  const Eigen::Index joints = corrected->rest_joints.rows(), all = frame.rest_joints.rows();
  if (all == joints) return;
  BODYLOOM_CHECK(joints > 0 && all > joints, "bones of cloth: a frame of ", all, " bones, expected at least ", joints);
  // The root's bone maps rest space to R x + t, so a rigid motion with it is R' Rᵀ about that point.
  const RowMatrix34f before = BoneAt(frame.bones.data(), 0), after = BoneAt(corrected->bones.data(), 0);
  const Eigen::Matrix3f R = after.leftCols<3>() * before.leftCols<3>().transpose();
  const Eigen::Vector3f t = after.col(3) - R * before.col(3);
  for (Eigen::Index k = joints; k < all; ++k) Append(TakenOn(R, t, BoneAt(frame.bones.data(), k)), &corrected->bones);
  corrected->rest_joints.conservativeResize(all, 3);
  corrected->rest_joints.bottomRows(all - joints) = frame.rest_joints.bottomRows(all - joints);
}

}  // namespace bodyloom
