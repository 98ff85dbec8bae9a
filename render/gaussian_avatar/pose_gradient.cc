// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/pose_gradient.h"

#include <algorithm>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "render/gaussian_avatar/pose_gaussians.h"

namespace bodyloom {
namespace {

using avatar_internal::kLanes;

constexpr int kLightSums = GaussianBody::kLightValues * kLanes;

/// Converts derivatives by [R | t], t = p − R j, to those by [R | p].
void ToJointPlace(const MatrixX3f& rest_joints, std::vector<float>* bones) {
  for (int j = 0; j < rest_joints.rows(); ++j) {
    for (int r = 0; r < 3; ++r) {
      float* row = bones->data() + 12 * j + 4 * r;
      for (int c = 0; c < 3; ++c) row[c] -= row[3] * rest_joints(j, c);
    }
  }
}

}  // namespace

void PoseGradient::Compute(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                           const PoseGaussiansOptions& options, const FloatColumns& by_posed,
                           AvatarGradient* gradient) {
  const avatar_internal::PoseTables tables = avatar_internal::TablesOf(body, faces, frame, options);
  const int count = body.size(), num_chunks = avatar_internal::NumChunks(count);
  BODYLOOM_CHECK(by_posed.rows() == count && by_posed.columns() == CameraGaussians::kNumColumns,
                 "pose gradient: derivatives are ", by_posed.rows(), " by ", by_posed.columns(), ", expected ", count,
                 " by ", static_cast<int>(CameraGaussians::kNumColumns));
  gradient->parameters.Resize(GaussianBody::kNumParameters, count);
  const int num_bone_sums = 12 * frame.num_joints();
  sums_.Resize(num_chunks, kLightSums + num_bone_sums);
  ParallelFor(num_chunks, options.num_threads, [&](int i) {
    const int first = i * avatar_internal::kRowsAChunk;
    float* sums = sums_.column(i);
    std::fill_n(sums, kLightSums + num_bone_sums, 0.0F);
    avatar_internal::PoseRowsBackward(
        tables, by_posed.data(), by_posed.stride(), first, std::min(count, first + avatar_internal::kRowsAChunk),
        gradient->parameters.data(), gradient->parameters.stride(), {sums + kLightSums, sums});
  });
  gradient->light.fill(0);
  gradient->bones.assign(num_bone_sums, 0);
  for (int chunk = 0; chunk < num_chunks; ++chunk) {
    const float* sums = sums_.column(chunk);
    for (int k = 0; k < kLightSums; ++k) gradient->light[k / kLanes] += sums[k];
    for (int k = 0; k < num_bone_sums; ++k) gradient->bones[k] += sums[kLightSums + k];
  }
  ToJointPlace(frame.rest_joints, &gradient->bones);
}

}  // namespace bodyloom
