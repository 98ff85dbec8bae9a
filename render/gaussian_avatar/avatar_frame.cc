// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/avatar_frame.h"

#include <algorithm>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"

namespace bodyloom {
namespace {

constexpr int kVerticesATask = 512;

}  // namespace

AvatarFrames::AvatarFrames(const BodyModel& model, const Eigen::VectorXd& betas)
    : model_(model), rest_joints_(model.RestJoints(betas)) {}

void AvatarFrames::MakeCorrectives(const std::vector<float>& features, int first, int last, AvatarFrame* frame) const {
  const PoseCorrectives& posedirs = model_.data().posedirs;
  for (int v = first; v < last; ++v) {
    float rest[3] = {};
    for (int b = posedirs.begin[v]; b < posedirs.begin[v + 1]; ++b) {
      const float* block = posedirs.block.data() + 27 * static_cast<int64_t>(b);
      const float* feature = features.data() + 9 * static_cast<int64_t>(posedirs.joint[b]);
      for (int r = 0; r < 3; ++r) {
        float sum = 0;
        for (int k = 0; k < 9; ++k) sum += block[9 * r + k] * feature[k];
        rest[r] += sum;
      }
    }
    float* to = frame->correctives.data() + 4 * static_cast<int64_t>(v);
    std::fill_n(to, 4, 0.0F);
    for (int k = model_.influence_begin()[v]; k < model_.influence_begin()[v + 1]; ++k) {
      const float* bone = frame->bones.data() + 12 * static_cast<int64_t>(model_.influence_joint()[k]);
      const auto weight = static_cast<float>(model_.influence_weight()[k]);
      for (int r = 0; r < 3; ++r) {
        to[r] += weight * (bone[4 * r] * rest[0] + bone[4 * r + 1] * rest[1] + bone[4 * r + 2] * rest[2]);
      }
    }
  }
}

void AvatarFrames::Make(const BodyPose& pose, const CameraPose& camera, int num_threads, AvatarFrame* frame) const {
  const int num_joints = model_.num_joints(), num_vertices = model_.num_vertices();
  BODYLOOM_CHECK(static_cast<int>(pose.rotations.size()) == num_joints, "avatar frame: the pose has ",
                 pose.rotations.size(), " joints, the body ", num_joints);
  const PosedSkeleton skeleton = PoseSkeleton(model_, rest_joints_, pose);
  frame->bones.resize(12 * static_cast<size_t>(num_joints));
  frame->rest_joints = rest_joints_.cast<float>();
  for (int j = 0; j < num_joints; ++j) {
    const Eigen::Matrix3d rotation = camera.camera_from_world_rotation * skeleton.world_rotations[j];
    const Eigen::Vector3d joint =
        camera.camera_from_world_rotation * skeleton.joints.row(j).transpose() + camera.camera_from_world_translation;
    const Eigen::Vector3d offset = joint - rotation * rest_joints_.row(j).transpose();
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) frame->bones[12 * j + 4 * r + c] = static_cast<float>(rotation(r, c));
      frame->bones[12 * j + 4 * r + 3] = static_cast<float>(offset[r]);
    }
  }
  frame->correctives.clear();
  if (model_.data().posedirs.empty()) return;
  std::vector<float> features(9 * static_cast<size_t>(num_joints));
  for (int j = 0; j < num_joints; ++j) {
    for (int k = 0; k < 9; ++k) {
      features[9 * j + k] = static_cast<float>(pose.rotations[j](k / 3, k % 3) - (k % 4 == 0 ? 1 : 0));
    }
  }
  frame->correctives.resize(4 * static_cast<size_t>(num_vertices));
  ParallelFor((num_vertices + kVerticesATask - 1) / kVerticesATask, num_threads, [&](int i) {
    MakeCorrectives(features, i * kVerticesATask, std::min(num_vertices, (i + 1) * kVerticesATask), frame);
  });
}

}  // namespace bodyloom
