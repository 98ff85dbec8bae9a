// SPDX-License-Identifier: Apache-2.0
/// Gaussians in the camera frame (x right, y down, z forward, metres): what render/splat/project_gaussians.h brings to
/// the screen, and the layout of the derivatives by them.
#pragma once

#include "bodyloom/render/splat/float_columns.h"

namespace bodyloom {

/// One row a Gaussian. The covariance is Σ = F Fᵀ with the factor F (3×3, metres), for instance A·R(q)·diag(e^s) of a
/// turned and scaled unit ball. Opacity o in [0, 1]; linear colour, any sign.
struct CameraGaussians {
  enum Column : int {
    kX,
    kY,
    kZ,
    kFactor,  ///< nine columns, row-major: F(r, c) is column kFactor + 3r + c
    kOpacity = kFactor + 9,
    kRed,
    kGreen,
    kBlue,
    kNumColumns,
  };
  FloatColumns columns;

  void Resize(int count) { columns.Resize(kNumColumns, count); }
  [[nodiscard]] int size() const { return columns.rows(); }
};

}  // namespace bodyloom
