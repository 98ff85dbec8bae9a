// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/skinning.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <numeric>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/body/skinning_simd.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using skinning_internal::kFrameLanes;

namespace {

/// Vertices a task: their correctives (160 kB for SMPL) stay in the second-level cache while all frames use them.
constexpr int kVerticesPerTask = 64;
/// Frames whose skeletons are held at a time.
constexpr int kGroupsPerPass = 8;

/// Skeletons of up to kFrameLanes frames, side by side as the inner loop wants them.
struct FrameGroup {
  AlignedFloats features, bones;
  std::vector<uint8_t> feature_is_zero;

  explicit FrameGroup(int num_joints)
      : features(ZeroFloats(size_t(9) * num_joints * kFrameLanes)),
        bones(ZeroFloats(size_t(12) * num_joints * kFrameLanes)),
        feature_is_zero(num_joints) {}

  void Fill(const BodyModel& model, const MatrixX3d& rest_joints, std::span<const BodyPose> poses, bool find_zeros,
            double* roots) {
    std::fill(feature_is_zero.begin(), feature_is_zero.end(), find_zeros);
    const Vector3d rest_root = rest_joints.row(0).transpose();
    for (size_t f = 0; f < poses.size(); ++f) {
      const PosedSkeleton skeleton = PoseSkeleton(model, rest_joints, poses[f]);
      const Vector3d root = skeleton.joints.row(0).transpose();
      Eigen::Map<Vector3d>(roots + 3 * f) = root;
      for (int j = 0; j < model.num_joints(); ++j) {
        const Matrix3d& R = poses[f].rotations[j];
        const Matrix3d& G = skeleton.world_rotations[j];
        const Vector3d t = skeleton.joints.row(j).transpose() - root - G * (rest_joints.row(j).transpose() - rest_root);
        float* feature = features.get() + size_t(9) * j * kFrameLanes + f;
        float* bone = bones.get() + size_t(12) * j * kFrameLanes + f;
        bool is_zero = true;
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) {
            const float x = static_cast<float>(R(r, c) - (r == c ? 1 : 0));
            is_zero = is_zero && x == 0;
            feature[(3 * r + c) * kFrameLanes] = x;
            bone[(4 * r + c) * kFrameLanes] = static_cast<float>(G(r, c));
          }
          bone[(4 * r + 3) * kFrameLanes] = static_cast<float>(t[r]);
        }
        if (!is_zero) feature_is_zero[j] = 0;
      }
    }
  }
};

}  // namespace

bool SkinnerOptions::IsValid(const BodyModel& model, std::string* why) const {
  if (num_threads < 1 || num_threads > 1024) {
    *why = Concatenate("num_threads is ", num_threads, ", expected 1..1024");
    return false;
  }
  for (int v : vertices) {
    if (v < 0 || v >= model.num_vertices()) {
      *why = Concatenate("vertex ", v, " is outside 0..", model.num_vertices() - 1);
      return false;
    }
  }
  return true;
}

Skinner::Skinner(const BodyModel& model, SkinnerOptions options) : model_(model), options_(std::move(options)) {
  std::string why;
  BODYLOOM_CHECK(options_.IsValid(model, &why), "Skinner: ", why);
  if (options_.vertices.empty()) {
    options_.vertices.resize(model.num_vertices());
    std::iota(options_.vertices.begin(), options_.vertices.end(), 0);
  }
  influence_weight_.assign(model.influence_weight().begin(), model.influence_weight().end());
  blocks_of_joint_.assign(model.num_joints(), 0);
  const PoseCorrectives& correctives = model.data().posedirs;
  if (!correctives.begin.empty()) {
    for (int v : options_.vertices) {
      for (int k = correctives.begin[v]; k < correctives.begin[v + 1]; ++k) ++blocks_of_joint_[correctives.joint[k]];
    }
  }
}

ShapedBody Skinner::Shape(const Eigen::VectorXd& betas) const {
  ShapedBody body;
  body.rest_joints = model_.RestJoints(betas);
  const MatrixX3d shaped = ShapeVertices(model_, betas);
  body.vertices.reserve(3 * options_.vertices.size());
  for (int v : options_.vertices) {
    for (int c = 0; c < 3; ++c) body.vertices.push_back(static_cast<float>(shaped(v, c) - body.rest_joints(0, c)));
  }
  return body;
}

SkinningSummary Skinner::Skin(const ShapedBody& body, std::span<const BodyPose> poses,
                              std::span<double> vertices) const {
  MatrixX3d roots;
  return Run(body, poses, nullptr, vertices.data(), vertices.size(), &roots);
}

SkinningSummary Skinner::SkinFromRoot(const ShapedBody& body, std::span<const BodyPose> poses,
                                      std::span<float> vertices, MatrixX3d* roots) const {
  return Run(body, poses, vertices.data(), nullptr, vertices.size(), roots);
}

SkinningSummary Skinner::Run(const ShapedBody& body, std::span<const BodyPose> poses, float* float_output,
                             double* double_output, size_t output_size, MatrixX3d* roots) const {
  const int J = model_.num_joints(), n = num_vertices();
  const size_t T = poses.size();
  BODYLOOM_CHECK(output_size == 3 * T * n, "Skinner: room for ", output_size,
                 " values, expected frames x vertices x 3 = ", T, " x ", n, " x 3");
  BODYLOOM_CHECK(body.rest_joints.rows() == J && body.vertices.size() == 3 * size_t(n), "Skinner: a shape of ",
                 body.rest_joints.rows(), " joints and ", body.vertices.size() / 3, " vertices, expected ", J, " and ",
                 n);
  for (size_t t = 0; t < T; ++t) {
    BODYLOOM_CHECK(static_cast<int>(poses[t].rotations.size()) == J, "Skinner: the pose of frame ", t, " has ",
                   poses[t].rotations.size(), " rotations, the body '", model_.name(), "' has ", J, " joints");
  }
  roots->resize(T, 3);

  skinning_internal::Body kernel_body;
  kernel_body.vertices = options_.vertices.data();
  kernel_body.rest = body.vertices.data();
  kernel_body.influence_begin = model_.influence_begin().data();
  kernel_body.influence_joint = model_.influence_joint().data();
  kernel_body.influence_weight = influence_weight_.data();
  const PoseCorrectives& correctives = model_.data().posedirs;
  if (!correctives.begin.empty()) {
    kernel_body.corrective_begin = correctives.begin.data();
    kernel_body.corrective_joint = correctives.joint.data();
    kernel_body.corrective_block = correctives.block.data();
  }

  SkinningSummary summary;
  summary.frames = static_cast<int>(T);
  summary.vertices = n;
  summary.simd_target = skinning_internal::ChosenSimdTarget();
  const int num_groups = static_cast<int>((T + kFrameLanes - 1) / kFrameLanes);
  std::vector<FrameGroup> groups;
  groups.reserve(static_cast<size_t>(std::min(num_groups, kGroupsPerPass)));
  for (int g = 0; g < std::min(num_groups, kGroupsPerPass); ++g) groups.emplace_back(J);
  for (int pass = 0; pass < num_groups; pass += kGroupsPerPass) {
    const int pass_groups = std::min(kGroupsPerPass, num_groups - pass);
    const auto group_poses = [&](int g) {
      const size_t first = size_t(pass + g) * kFrameLanes;
      return poses.subspan(first, std::min<size_t>(kFrameLanes, T - first));
    };
    ParallelFor(pass_groups, options_.num_threads, [&](int g) {
      groups[g].Fill(model_, body.rest_joints, group_poses(g), options_.skip_resting_joints,
                     roots->data() + 3 * size_t(pass + g) * kFrameLanes);
    });
    ParallelFor((n + kVerticesPerTask - 1) / kVerticesPerTask, options_.num_threads, [&](int task) {
      const int first = task * kVerticesPerTask, last = std::min(n, first + kVerticesPerTask);
      for (int g = 0; g < pass_groups; ++g) {
        const size_t first_frame = size_t(pass + g) * kFrameLanes;
        skinning_internal::Frames frames;
        frames.num_frames = static_cast<int>(group_poses(g).size());
        frames.features = groups[g].features.get();
        frames.feature_is_zero = groups[g].feature_is_zero.data();
        frames.bones = groups[g].bones.get();
        frames.roots = roots->data() + 3 * first_frame;
        frames.output_stride = 3 * int64_t{n};
        if (float_output != nullptr) frames.float_output = float_output + first_frame * frames.output_stride;
        if (double_output != nullptr) frames.double_output = double_output + first_frame * frames.output_stride;
        SkinVertices(kernel_body, frames, first, last);
      }
    });
    for (int g = 0; g < pass_groups; ++g) {
      for (int j = 1; j < J; ++j) {
        const int64_t blocks = blocks_of_joint_[j] * static_cast<int64_t>(group_poses(g).size());
        (groups[g].feature_is_zero[j] ? summary.corrective_blocks_skipped : summary.corrective_blocks) += blocks;
      }
    }
  }
  return summary;
}

std::vector<int> StrongestJoints(const BodyModel& body) {
  std::vector<int> strongest(body.num_vertices(), 0);
  for (int v = 0; v < body.num_vertices(); ++v) {
    double maximum = -1;
    for (int k = body.influence_begin()[v]; k < body.influence_begin()[v + 1]; ++k) {
      if (body.influence_weight()[k] > maximum)
        maximum = body.influence_weight()[k], strongest[v] = body.influence_joint()[k];
    }
  }
  return strongest;
}

std::vector<double> WeightsBelow(const BodyModel& body, const std::vector<std::string>& joints) {
  std::vector<bool> counts(body.num_joints(), false);
  for (const std::string& name : joints) {
    const int joint = body.FindJoint(name);
    if (joint >= 0) counts[joint] = true;
  }
  for (int j = 1; j < body.num_joints(); ++j) counts[j] = counts[j] || counts[body.parents()[j]];
  std::vector<double> weights(body.num_vertices(), 0.0);
  for (int v = 0; v < body.num_vertices(); ++v) {
    for (int k = body.influence_begin()[v]; k < body.influence_begin()[v + 1]; ++k) {
      if (counts[body.influence_joint()[k]]) weights[v] += body.influence_weight()[k];
    }
  }
  return weights;
}

}  // namespace bodyloom
