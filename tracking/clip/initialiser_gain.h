// SPDX-License-Identifier: Apache-2.0
/// Compares a fit with its initialiser: the distance between them, and the reprojection errors of both.
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Median and 95th percentile; NaN without values.
struct MedianAndP95 {
  double median = 0, p95 = 0;
};

/// Differences over the frames that both have. Positions are in the camera's axes; each has its own shape, so a change
/// of shape counts.
struct InitialiserGain {
  int frames = 0;
  MedianAndP95 joint_mm;      ///< of all joints but the root, after aligning the root joints
  MedianAndP95 root_mm;       ///< of the root joint itself; NaN under weak perspective, where its position is unknown
  MedianAndP95 rotation_deg;  ///< angle between the rotations of a joint against its parent, of all joints but the root
  MedianAndP95 root_deg;      ///< the same of the root
  int landmarks = 0;          ///< 2D joints of confidence above 0.3 that both have in front of their camera
  MedianAndP95 initialiser_px, fit_px;  ///< distance of these 2D joints to their detections
};

/// `initialiser` has as many frames as `fit`, NaN for missing ones, and is in the frame of `initialiser_camera`;
/// `keypoints` may be null, or share no landmark with the body: then there are no reprojection errors. Throws
/// std::invalid_argument for another number of frames.
InitialiserGain GainOverInitialiser(const BodyModel& body, const KeypointSequence* keypoints, const Motion& initialiser,
                                    const Camera& initialiser_camera, const Track& fit);

/// The same for a start from landmarks (T of 21×3 in the frame of `camera`, LifterPointNames(); without rows: missing):
/// joint_mm is of these landmarks after aligning the mid-hips, root_mm is of the mid-hips; there are no rotations.
InitialiserGain GainOverLandmarks(const BodyModel& body, const KeypointSequence* keypoints,
                                  const std::vector<MatrixX3d>& landmarks, const Camera& camera, const Track& fit);

}  // namespace bodyloom
