// SPDX-License-Identifier: Apache-2.0
/// The inner loops of render/gaussian_avatar/pose_gaussians.h and pose_gradient.h: plain arrays in, plain arrays out,
/// compiled once per instruction set like render/raster/raster_simd.h. The same bits from all of them: every operation
/// is one correctly rounded IEEE operation, never fused.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/gaussian_avatar/gaussian_body.h"

namespace bodyloom::avatar_internal {

inline constexpr int kLanes = FloatColumns::kLanes;

struct PoseTables {
  const float* parameters = nullptr;  ///< columns of GaussianBody
  size_t parameter_stride = 0;
  const int32_t* joints = nullptr;
  const float* bones = nullptr;        ///< J × 12
  const float* correctives = nullptr;  ///< V × 4, or null
  const int32_t* faces = nullptr;      ///< F × 3
  const SkinAnchor* anchors = nullptr;
  const float* light = nullptr;             ///< 27
  const float* light_from_frame = nullptr;  ///< 9
};

/// Rows first..last−1, first a multiple of kLanes, to columns of CameraGaussians. Spare rows after the last are
/// written.
void PoseRows(const PoseTables& tables, int first, int last, float* posed, size_t posed_stride);

/// Sums over rows, accumulated.
struct PoseSums {
  float* bones = nullptr;  ///< J × 12: by [R_k | t_k]
  float* light = nullptr;  ///< 27 × kLanes
};
/// `by_posed`: derivatives by columns of CameraGaussians. Writes those by the parameters, adds to the sums.
void PoseRowsBackward(const PoseTables& tables, const float* by_posed, size_t by_posed_stride, int first, int last,
                      float* by_parameters, size_t by_parameter_stride, const PoseSums& sums);

}  // namespace bodyloom::avatar_internal
