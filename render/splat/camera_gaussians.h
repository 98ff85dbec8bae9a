// SPDX-License-Identifier: Apache-2.0
/// Gaussians in the camera frame (x right, y down, z forward, metres): what render/splat/project_gaussians.h brings to
/// the screen, and the layout of the derivatives by them.
#pragma once

#include "render/splat/float_columns.h"

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

// Gaussians on the screen: what a picture of them is drawn from (render/splat/splat_picture.h), and the layout of the
// derivatives by them.

/// One row a Gaussian. At a pixel, d = pixel − mean away from it, it covers
///   α = min(0.99, o·exp(−½ (K_xx d_x² + 2 K_xy d_x d_y + K_yy d_y²))),   nothing where o·exp(…) < 1/255.
///
/// A row that is not drawn has half extents of −1 and zeros elsewhere. These are not drawn, and no derivative reaches
/// them:
/// - any number of it is not finite, or a colour is beyond ±kLargestColour;
/// - it lies behind the near plane (pinhole);
/// - its opacity is below 1/255, or above 1;
/// - its reach is beyond kLargestReachPx, or its mean beyond kFarthestMeanPx;
/// - it is flat on the screen: its covariance there has no inverse in float. That takes a low-pass of (nearly) zero:
///   with the usual one a Gaussian without extent is a dot, and is drawn.
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
    kNumGradients,           ///< derivatives are by these columns; by K_xy as the one number it is
    kDepth = kNumGradients,  ///< z, metres: smaller is in front
    kLog2Opacity,
    kHalfWidth,  ///< pixels of α ≥ 1/255 lie within mean ± half extent
    kHalfHeight,
    kNumColumns,
  };
  static constexpr float kLeastAlpha = 1.0F / 255, kLargestAlpha = 0.99F;
  static constexpr float kLargestColour = 1e6F, kLargestReachPx = 4096, kFarthestMeanPx = 1e6F;

  FloatColumns columns;

  void Resize(int count) { columns.Resize(kNumColumns, count); }
  [[nodiscard]] int size() const { return columns.rows(); }
  [[nodiscard]] bool IsDrawn(int i) const { return columns(i, kHalfWidth) > 0; }
};

}  // namespace bodyloom
