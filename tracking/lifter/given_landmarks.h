// SPDX-License-Identifier: Apache-2.0
/// 3D landmarks of another system in the place of the lifter's.
#pragma once

#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/observations.h"
#include "tracking/lifter/lifter_reading.h"

namespace bodyloom {

/// Scales of the error (LiftedFrame::sigma) of landmarks whose system does not say: about 4 cm across and 7 cm along
/// the view for each coordinate, as image networks of 2025 report.
struct GivenLandmarkSigma {
  double across_m = 0.02, along_m = 0.035;
};

/// In every frame of `points` that has rows (21×3, metres, camera axes, LifterPointNames()), the frame's landmarks and
/// limbs become these, relative to the mid-hip, in units of the points' own torso + leg length; a limb has one
/// hypothesis. The vertical and the contacts stay what the lifter says, and so do the other frames. Throws
/// std::invalid_argument for another number of frames and for points without a torso and legs.
void TakeGivenLandmarks(const std::vector<MatrixX3d>& points, const GivenLandmarkSigma& sigma,
                        std::vector<LiftedFrame>* frames);

// 2D joints read off DensePose part labels, so that a clip with nothing else can be started from.
//
// Two parts that meet, meet at a joint: upper and lower arm at the elbow, lower arm and hand at the wrist, torso and
// thigh at the hip, thigh and shin at the knee, shin and foot at the ankle. The joint is the median of the pixels
// where the two labels touch; a limb's part that lies across another body part touches it too, but not its own
// neighbour. The shoulder is where the upper arm touches the torso farthest from the elbow, as a hanging arm touches
// it all the way down. Nose and ears come from the two halves of the head, and the torso's front or back says which
// way it looks.
//
// The boundary between two charts is not the joint itself; it is taken as it stands, a median of less than 0.05 of the
// person's height away (tests/data_tools/observations/part_labels_test.cc).

struct PartKeypointsOptions {
  double min_contact = 0.01;  ///< shortest boundary that counts, as a share of the person's height in the image
  double confidence = 0.6;    ///< of a joint whose boundary is seen in full; these are not a detector's joints
};

/// T×(17 + 2) keypoints: CocoNames() and left_big_toe, right_big_toe; confidence 0 where the parts do not touch. The
/// labels must be DensePose's chart numbers 1..24 (not merged). Throws std::invalid_argument when there are no frames.
KeypointSequence KeypointsFromPartLabels(const PartLabelSequence& labels, const PartKeypointsOptions& options = {});

}  // namespace bodyloom
