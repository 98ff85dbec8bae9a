// SPDX-License-Identifier: Apache-2.0
/// Options of the rendered-UV term.
#pragma once

namespace bodyloom {

/// L_r of paper A: where a dense keypoint's pixel sees the chart that the detector named, its residual is taken in UV
/// (rendered_uv_term.h) instead of in the image.
struct RenderedUvOptions {
  double weight = 1;  ///< λ_r; 0: off
  /// Run only when the keypoints' noise is known to lie on the surface (DenseSequence::uv_sigma). Where it lies in the
  /// pixels instead, reprojection is the better residual (docs/benchmarks.md).
  bool only_with_uv_noise = true;
  int max_points = 1000;    ///< keypoints of a frame that are taken in UV, spread evenly over the parts
  int rounds = 1;           ///< solves on the coarse frames; whitening is refreshed before each
  int max_iterations = 8;   ///< solver iterations of a round
  double min_cosine = 0.5;  ///< between the ray and the surface normal; more grazing pixels are left to reprojection
  /// What an unmatched pixel costs: true: its reprojection error, so that it still pulls; false: the kernel's
  /// saturation.
  bool unmatched_reproject = true;
};

}  // namespace bodyloom
