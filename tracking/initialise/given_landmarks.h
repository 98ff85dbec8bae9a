// SPDX-License-Identifier: Apache-2.0
/// 3D landmarks of another system in the place of the lifter's.
#pragma once

#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/tracking/initialise/lifter_reading.h"

namespace bodyloom {

/// Scales of the error (LiftedFrame::sigma) of landmarks whose system does not say: about 4 cm across and 7 cm along the
/// view for each coordinate, as image networks of 2025 report.
struct GivenLandmarkSigma {
  double across_m = 0.02, along_m = 0.035;
};

/// In every frame of `points` that has rows (21×3, metres, camera axes, LifterPointNames()), the frame's landmarks and
/// limbs become these, relative to the mid-hip, in units of the points' own torso + leg length; a limb has one
/// hypothesis. The vertical and the contacts stay what the lifter says, and so do the other frames. Throws
/// std::invalid_argument for another number of frames and for points without a torso and legs.
void TakeGivenLandmarks(const std::vector<MatrixX3d>& points, const GivenLandmarkSigma& sigma,
                        std::vector<LiftedFrame>* frames);

}  // namespace bodyloom
