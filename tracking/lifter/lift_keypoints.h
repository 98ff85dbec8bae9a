// SPDX-License-Identifier: Apache-2.0
/// Lifts 2D landmarks of a clip to 3D landmarks with their uncertainty, by the lifter network.
///
/// The network works at about 20 frames a second. Faster clips are processed in k = round(fps/20) interleaved phases,
/// slower ones with interpolated frames in between. It runs a second time on the mirrored clip: torso landmarks, up and
/// contact are averaged, and a limb's hypotheses of both runs are concatenated. The stretches between cuts are
/// processed separately.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/lifter_weights.h"
#include "geometry/scene/observations.h"
#include "tracking/lifter/lifter_reading.h"

namespace bodyloom {

struct LiftOptions {
  bool mirrored = true;    ///< the second run
  bool all_phases = true;  ///< false: one phase, frames in between interpolated; faster and rougher
  int num_threads = 1;
  int last_samples = 0;  ///< above 0: only that many last samples of each phase are computed; earlier frames are empty
};

/// Interpolates between two frames, s in [0, 1]: points linearly, limbs and uncertainty of the nearer frame.
LiftedFrame InterpolateLifted(const LiftedFrame& a, const LiftedFrame& b, double s);

/// Returns one entry a frame; empty when no frame shows a landmark. `cut_before` (T, or empty) marks frames that do not
/// continue the one before. Throws std::invalid_argument for weights of another number of inputs.
std::vector<LiftedFrame> LiftKeypoints(const KeypointSequence& keypoints, const Camera& camera, bool focal_known,
                                       const std::vector<char>& cut_before, const LifterWeights& weights,
                                       const LiftOptions& options);

}  // namespace bodyloom
