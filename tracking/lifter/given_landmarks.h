// SPDX-License-Identifier: Apache-2.0
/// Replaces the lifter's landmarks by 3D landmarks of another system.
#pragma once

#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/observations.h"
#include "tracking/lifter/lifter_reading.h"

namespace bodyloom {

/// Scales of the error (LiftedFrame::sigma) of landmarks whose system gives none: about 4 cm across and 7 cm along the
/// view for each coordinate, as image networks of 2025 report.
struct GivenLandmarkSigma {
  double across_m = 0.02, along_m = 0.035;
};

/// Replaces landmarks and limbs in every frame for which `points` has rows (21×3, metres, camera axes,
/// LifterPointNames()): relative to the mid-hip, in units of the points' own torso + leg length, with one hypothesis a
/// limb. Vertical and contacts remain the lifter's, and so do the other frames. Throws std::invalid_argument for
/// another number of frames and for points without a torso and legs.
void TakeGivenLandmarks(const std::vector<MatrixX3d>& points, const GivenLandmarkSigma& sigma,
                        std::vector<LiftedFrame>* frames);

// 2D joints from DensePose part labels, as a start for clips without other joints.
//
// Neighbouring parts meet at a joint: upper and lower arm at the elbow, lower arm and hand at the wrist, torso and
// thigh at the hip, thigh and shin at the knee, shin and foot at the ankle. The joint is the median of the pixels where
// the two labels touch; a limb in front of another body part touches that part too, which is not its neighbour. The
// shoulder is the contact of upper arm and torso farthest from the elbow, since a hanging arm touches the torso along
// its whole length. Nose and ears come from the two halves of the head, and its direction from the visible side of the
// torso, front or back.
//
// The boundary between two charts is not the joint itself, but is used as it is: the median distance is below 0.05 of
// the person's height (tests/data_tools/observations/part_labels_test.cc).

struct PartKeypointsOptions {
  double min_contact = 0.01;  ///< shortest boundary that counts, as a share of the person's height in the image
  double confidence = 0.6;    ///< of a joint whose boundary is fully visible; lower than a detector's
};

/// T×(17 + 2) keypoints: CocoNames() and left_big_toe, right_big_toe; confidence 0 where the parts do not touch. The
/// labels must be DensePose's chart numbers 1..24 (not merged). Throws std::invalid_argument when there are no frames.
KeypointSequence KeypointsFromPartLabels(const PartLabelSequence& labels, const PartKeypointsOptions& options = {});

}  // namespace bodyloom
