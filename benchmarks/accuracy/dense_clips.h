// SPDX-License-Identifier: Apache-2.0
/// Clip utilities and dense synthetic clips shared by several benchmarks.
#pragma once

#include <string>

#include "benchmarks/accuracy/cramer_rao.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Noise by name. `pixel`: 1 px Gaussian. `densepose`: 1 px, UV noise 0.02 of a chart, 8-bit UV, 5 % outliers, each
/// part missing 5 % of the time. Throws std::invalid_argument for other names.
DenseFaultOptions DenseFaults(const std::string& noise);

/// The first `frames` frames; all of them if it is 0 or larger than their number.
Motion FirstFrames(Motion motion, int frames);
KeypointSequence FirstFrames(KeypointSequence keypoints, int frames);

/// Sets the confidence of toes and heels to 0, as most detectors lack them.
void LeaveOutFeet(KeypointSequence* keypoints);

/// First part of the file's name.
std::string MotionName(const std::string& path);

// Cramér–Rao bound of a synthetic clip's dense keypoints, as expected per-vertex projection error.

struct DenseBoundOptions {
  /// Standard deviations of priors centred on the truth, which keep unobserved parameters (a hidden hand) finite.
  double rotation_sigma_rad = 0.5, beta_sigma = 1;
  /// Adds the information of a smoothness prior: the angular acceleration of every joint and the acceleration of the
  /// translation are white noise with their root mean square in this motion.
  bool smooth = false;
  double outlier_sigmas = 6;  ///< keypoints whose label lies farther from the truth carry no information
  int vertex_step = 10;
  int image_side_px = 512;
};

/// Computes the bound with shared shape and known camera; every keypoint has the noise of its sigma_px. Constant errors
/// (8-bit rounding) are not modelled. Without `smooth` frames are independent, so a tracker that uses time can be
/// better. Throws std::runtime_error when the information is singular.
ProjectionBound DenseBound(const BodyModel& body, const SynthClip& clip, const DenseBoundOptions& options = {});

}  // namespace bodyloom
