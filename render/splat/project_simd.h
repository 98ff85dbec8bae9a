// SPDX-License-Identifier: Apache-2.0
/// The inner loops of render/splat/project_gaussians.h: plain arrays in, plain arrays out, compiled once per
/// instruction set like render/raster/raster_simd.h. The same bits from all of them: every operation is one correctly
/// rounded IEEE operation, never fused (2^x and log2: render/splat/float_math-inl.h).
#pragma once

#include <cstddef>

namespace bodyloom::splat_internal {

/// Pinhole: mean = focal · (X, Y)/Z + centre. Weak perspective (divide_by_depth false): mean = focal · (X, Y) + centre.
struct ScreenProjection {
  bool divide_by_depth = true;
  float focal_x = 1, focal_y = 1, centre_x = 0, centre_y = 0;
  float near_m = 0.1F;
  float low_pass_px2 = 0;
};

/// A table of columns (render/splat/float_columns.h).
struct Table {
  float* data = nullptr;
  size_t stride = 0;
};
struct ConstTable {
  const float* data = nullptr;
  size_t stride = 0;
};

/// Rows first..last−1, first a multiple of FloatColumns::kLanes. `camera`: columns of CameraGaussians, `screen` of
/// ScreenGaussians. Spare rows after the last are written.
void ProjectRows(const ScreenProjection& projection, ConstTable camera, int first, int last, Table screen);

/// The derivatives by the rows of CameraGaussians from those by ScreenGaussians (kNumGradients columns).
void ProjectRowsBackward(const ScreenProjection& projection, ConstTable camera, ConstTable screen, ConstTable by_screen,
                         int first, int last, Table by_camera);

}  // namespace bodyloom::splat_internal
