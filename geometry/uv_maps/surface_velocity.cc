// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/surface_velocity.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <numeric>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/body/skinning_simd.h"
#include "geometry/math/arrays.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using skinning_internal::kFrameLanes;

std::string ToString(SurfaceFrame frame) {
  switch (frame) {
    case SurfaceFrame::kCamera:
      return "camera";
    case SurfaceFrame::kWorld:
      return "world";
    case SurfaceFrame::kBody:
      return "body";
  }
  return "unknown";
}

std::vector<std::optional<BodyPose>> PosesInFrame(const BodyModel& body, const Track& track, SurfaceFrame frame,
                                                  const CameraPose& camera_pose) {
  const Motion& motion = track.motion;
  const bool weak = track.camera.model == CameraModel::kWeakPerspective && track.weak_camera.rows() > 0;
  const Vector3d rest_root = body.RestJoints(motion.betas).row(0).transpose();
  const Matrix3d world_from_camera = camera_pose.camera_from_world_rotation.transpose();
  std::vector<std::optional<BodyPose>> poses(motion.num_frames());
  for (int t = 0; t < motion.num_frames(); ++t) {
    Vector3d trans = motion.trans.row(t).transpose();
    if (weak) trans += Vector3d(track.weak_camera(t, 1), track.weak_camera(t, 2), 0);
    if (track.frame_status[t] == FrameStatus::kLost || !motion.poses.row(t).allFinite() || !trans.allFinite()) continue;
    BodyPose pose = PoseFromAxisAngle(body, motion.poses.row(t).transpose(), trans);
    if (frame == SurfaceFrame::kBody) {
      pose.rotations[0].setIdentity();
      pose.trans.setZero();
    } else if (frame == SurfaceFrame::kWorld) {
      pose.rotations[0] = world_from_camera * pose.rotations[0];
      const Vector3d root = rest_root + trans;
      pose.trans = world_from_camera * (root - camera_pose.camera_from_world_translation) - rest_root;
    }
    poses[t] = std::move(pose);
  }
  return poses;
}

void DifferenceVertices(const VelocityStencil& stencil, std::span<const float* const> vertices,
                        std::span<const Vector3d> roots, std::span<float> velocities) {
  const size_t n = stencil.weights.size(), size = velocities.size();
  Vector3d root_velocity = Vector3d::Zero();
  for (size_t k = 0; k < n; ++k) root_velocity += stencil.weights[k] * roots[k];
  const float of_root[3] = {static_cast<float>(root_velocity[0]), static_cast<float>(root_velocity[1]),
                            static_cast<float>(root_velocity[2])};
  // Blocks that stay in the first-level cache while all frames are added to them.
  constexpr size_t kBlock = 1536;
  for (size_t begin = 0; begin < size; begin += kBlock) {
    const size_t end = std::min(size, begin + kBlock);
    float* const out = velocities.data();
    for (size_t i = begin; i < end; i += 3) {
      for (int c = 0; c < 3; ++c) out[i + c] = of_root[c];
    }
    for (size_t k = 0; k < n; ++k) {
      const float w = static_cast<float>(stencil.weights[k]);
      const float* const x = vertices[k];
      for (size_t i = begin; i < end; ++i) out[i] += w * x[i];
    }
  }
}

PoseRates RatesOf(const VelocityStencil& stencil, std::span<const BodyPose* const> poses, const BodyPose& at) {
  PoseRates rates;
  rates.angular.assign(at.rotations.size(), Vector3d::Zero());
  for (size_t k = 0; k < stencil.weights.size(); ++k) {
    const double w = stencil.weights[k];
    rates.trans += w * poses[k]->trans;
    for (size_t j = 0; j < at.rotations.size(); ++j) {
      rates.angular[j] += w * AxisAngleFromRotation(at.rotations[j].transpose() * poses[k]->rotations[j]);
    }
  }
  return rates;
}

namespace {

/// kFrameLanes frames of n values each, as the skinning loop wants them.
class LaneArray {
 public:
  explicit LaneArray(int n) : values_(ZeroFloats(size_t(n) * kFrameLanes)) {}
  void Set(int entry, size_t frame, double value) {
    values_[size_t(entry) * kFrameLanes + frame] = static_cast<float>(value);
  }
  [[nodiscard]] const float* data() const { return values_.get(); }

 private:
  AlignedFloats values_;
};

constexpr int kVerticesPerVelocityTask = 512;

}  // namespace

VelocitySkinner::VelocitySkinner(const BodyModel& model)
    : model_(model),
      all_vertices_(model.num_vertices()),
      influence_weight_(model.influence_weight().begin(), model.influence_weight().end()) {
  std::iota(all_vertices_.begin(), all_vertices_.end(), 0);
}

void VelocitySkinner::Velocities(const ShapedBody& shape, std::span<const BodyPose> poses,
                                 std::span<const PoseRates> rates, std::span<float> velocities, int num_threads) const {
  const int J = model_.num_joints(), V = model_.num_vertices();
  const size_t T = poses.size(), stride = 3 * size_t(V);
  BODYLOOM_CHECK(rates.size() == T && velocities.size() == T * stride && shape.vertices.size() == stride,
                 "velocities: ", T, " poses, ", rates.size(), " rates, room for ", velocities.size(),
                 " values, a shape of ", shape.vertices.size() / 3, " vertices; expected ", V, " vertices");
  const std::vector<float> origin(stride, 0.0F);
  skinning_internal::Body moving;  // [Ġ | ṫ] on the corrected rest position
  moving.vertices = all_vertices_.data();
  moving.rest = shape.vertices.data();
  moving.influence_begin = model_.influence_begin().data();
  moving.influence_joint = model_.influence_joint().data();
  moving.influence_weight = influence_weight_.data();
  const PoseCorrectives& correctives = model_.data().posedirs;
  const bool corrects = !correctives.begin.empty();
  if (corrects) {
    moving.corrective_begin = correctives.begin.data();
    moving.corrective_joint = correctives.joint.data();
    moving.corrective_block = correctives.block.data();
  }
  skinning_internal::Body correcting = moving;  // [G | 0] on the change of the correctives
  correcting.rest = origin.data();

  const int num_groups = static_cast<int>((T + kFrameLanes - 1) / kFrameLanes);
  for (int g = 0; g < num_groups; ++g) {
    const size_t first = size_t(g) * kFrameLanes, count = std::min<size_t>(kFrameLanes, T - first);
    LaneArray features(9 * J), feature_rates(9 * J), bones(12 * J), bone_rates(12 * J);
    std::vector<Vector3d> root_velocity(count);
    std::vector<uint8_t> is_zero(J, 0);
    for (size_t f = 0; f < count; ++f) {
      const BodyPose& pose = poses[first + f];
      const PoseRates& rate = rates[first + f];
      BODYLOOM_CHECK(static_cast<int>(rate.angular.size()) == J, "velocities: rates of ", rate.angular.size(),
                     " joints, the body '", model_.name(), "' has ", J);
      const PosedSkeleton skeleton = PoseSkeleton(model_, shape.rest_joints, pose);
      std::vector<Matrix3d> rotation_rates(J);           // Ġ
      std::vector<Vector3d> joint_rates(J, rate.trans);  // ṗ
      for (int j = 0; j < J; ++j) {
        const int p = model_.parents()[j];
        const Matrix3d own_rate = pose.rotations[j] * Skew(rate.angular[j]);  // Ṙ
        if (p < 0) {
          rotation_rates[j] = own_rate;
        } else {
          rotation_rates[j] = rotation_rates[p] * pose.rotations[j] + skeleton.world_rotations[p] * own_rate;
          joint_rates[j] =
              joint_rates[p] + rotation_rates[p] * (shape.rest_joints.row(j) - shape.rest_joints.row(p)).transpose();
        }
        const Vector3d from_root = (shape.rest_joints.row(j) - shape.rest_joints.row(0)).transpose();
        const Vector3d offset_rate = joint_rates[j] - joint_rates[0] - rotation_rates[j] * from_root;
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) {
            features.Set(9 * j + 3 * r + c, f, pose.rotations[j](r, c) - (r == c ? 1 : 0));
            feature_rates.Set(9 * j + 3 * r + c, f, own_rate(r, c));
            bones.Set(12 * j + 4 * r + c, f, skeleton.world_rotations[j](r, c));
            bone_rates.Set(12 * j + 4 * r + c, f, rotation_rates[j](r, c));
          }
          bone_rates.Set(12 * j + 4 * r + 3, f, offset_rate[r]);
        }
      }
      root_velocity[f] = joint_rates[0];
    }
    skinning_internal::Frames frames;
    frames.num_frames = static_cast<int>(count);
    frames.features = features.data();
    frames.feature_is_zero = is_zero.data();
    frames.bones = bone_rates.data();
    frames.output_stride = static_cast<int64_t>(stride);
    frames.float_output = velocities.data() + first * stride;
    std::vector<float> corrective_part(corrects ? count * stride : 0);
    skinning_internal::Frames corrective_frames = frames;
    corrective_frames.features = feature_rates.data();
    corrective_frames.bones = bones.data();
    corrective_frames.float_output = corrective_part.data();
    ParallelFor((V + kVerticesPerVelocityTask - 1) / kVerticesPerVelocityTask, num_threads, [&](int task) {
      const int begin = task * kVerticesPerVelocityTask, end = std::min(V, begin + kVerticesPerVelocityTask);
      SkinVertices(moving, frames, begin, end);
      if (corrects) SkinVertices(correcting, corrective_frames, begin, end);
      for (size_t f = 0; f < count; ++f) {
        for (int v = begin; v < end; ++v) {
          for (int c = 0; c < 3; ++c) {
            float& value = frames.float_output[f * stride + 3 * size_t(v) + c];
            if (corrects) value += corrective_part[f * stride + 3 * size_t(v) + c];
            value += static_cast<float>(root_velocity[f][c]);
          }
        }
      }
    });
  }
}

}  // namespace bodyloom
