// SPDX-License-Identifier: Apache-2.0
/// Parts of clips, and the dense synthetic ones, that several benchmarks share.
#pragma once

#include <string>

#include "benchmarks/accuracy/cramer_rao.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// `pixel`: 1 px Gaussian. `densepose`: 1 px, UV noise 0.02 of a chart, 8-bit UV, 5 % outliers, each part missing 5 %
/// of the time. Throws std::invalid_argument for other names.
DenseFaultOptions DenseFaults(const std::string& noise);

/// All frames when `frames` is 0 or more than there are.
Motion FirstFrames(Motion motion, int frames);
KeypointSequence FirstFrames(KeypointSequence keypoints, int frames);

/// Toes and heels get confidence 0: what most detectors show.
void LeaveOutFeet(KeypointSequence* keypoints);

/// First part of the file's name.
std::string MotionName(const std::string& path);

// The Cramér–Rao bound of a synthetic clip's dense keypoints, as expected per-vertex projection error.

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
