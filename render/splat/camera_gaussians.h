// SPDX-License-Identifier: Apache-2.0
/// Gaussians in the camera frame (x right, y down, z forward, metres), the input of render/splat/project_gaussians.h,
/// and on the screen, its output. Derivatives have the same layout.
#pragma once

#include "render/splat/float_columns.h"

namespace bodyloom {

/// One row per Gaussian. The covariance is Σ = F Fᵀ with the factor F (3×3, metres), for instance A·R(q)·diag(e^s) for
/// a rotated and scaled unit sphere. Opacity o in [0, 1]; linear colour, any sign.
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

/// Projected Gaussians, one row each. At a pixel with offset d = pixel − mean the opacity is
///   α = min(0.99, o·exp(−½ (K_xx d_x² + 2 K_xy d_x d_y + K_yy d_y²))),   0 where o·exp(…) < 1/255.
///
/// A row that is not drawn has half extents of −1 and zeros elsewhere, and zero derivatives. A Gaussian is not drawn if
/// - any of its numbers is not finite, or a colour is beyond ±kLargestColour;
/// - it lies behind the near plane (pinhole);
/// - its opacity is below 1/255, or above 1;
/// - its reach is beyond kLargestReachPx, or its mean beyond kFarthestMeanPx;
/// - its covariance on the screen is singular in float, which requires a low-pass of (nearly) zero; with the usual one
///   a Gaussian without extent is drawn as a dot.
struct ScreenGaussians {
  enum Column : int {
    kMeanX,  ///< pixels; centres are at integer coordinates
    kMeanY,
    kConicXx,  ///< K = (covariance on the screen)⁻¹, 1/px²
    kConicXy,
    kConicYy,
    kOpacity,
    kRed,
    kGreen,
    kBlue,
    kNumGradients,           ///< derivatives have these columns; that by K_xy counts K_xy = K_yx once
    kDepth = kNumGradients,  ///< z, metres: smaller is in front
    kLog2Opacity,
    kHalfWidth,  ///< pixels of α ≥ 1/255 lie within mean ± half extent
    kHalfHeight,
    kNumColumns,
  };
  static constexpr float kMinAlpha = 1.0F / 255, kLargestAlpha = 0.99F;
  static constexpr float kLargestColour = 1e6F, kLargestReachPx = 4096, kFarthestMeanPx = 1e6F;

  FloatColumns columns;

  void Resize(int count) { columns.Resize(kNumColumns, count); }
  [[nodiscard]] int size() const { return columns.rows(); }
  [[nodiscard]] bool IsDrawn(int i) const { return columns(i, kHalfWidth) > 0; }
};

}  // namespace bodyloom
