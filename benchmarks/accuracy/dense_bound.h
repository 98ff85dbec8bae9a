// SPDX-License-Identifier: Apache-2.0
/// The Cramér–Rao bound of a synthetic clip's dense keypoints, as expected per-vertex projection error.
#pragma once

#include "bodyloom/data_tools/evaluation/cramer_rao.h"
#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"
#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

struct DenseBoundOptions {
  /// Spread of what is known beforehand, about the truth: keeps what no keypoint shows (a hidden hand) finite.
  double rotation_sigma_rad = 0.5, beta_sigma = 1;
  /// Adds the information of a motion's smoothness: every joint's angular acceleration and the translation's
  /// acceleration are white with the size (root mean square) that they have in this motion.
  bool smooth = false;
  double outlier_sigmas = 6;  ///< keypoints whose label lies farther from the truth carry no information
  int vertex_step = 10;
  int image_side_px = 512;
};

/// The shape is shared, the camera is known; every keypoint has the noise of its sigma_px. Constant errors (8-bit
/// rounding) are not in it. Without `smooth` frames are independent, and a tracker that uses time can be better.
/// Throws std::runtime_error when the information is singular.
ProjectionBound DenseBound(const BodyModel& body, const SynthClip& clip, const DenseBoundOptions& options = {});

}  // namespace bodyloom
