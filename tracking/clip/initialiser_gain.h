// SPDX-License-Identifier: Apache-2.0
/// What a fit made of its initialiser: how far it moved, and what that gained in the image.
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// A median and the value below which 95 % lie; NaN of nothing.
struct MedianAndP95 {
  double median = 0, p95 = 0;
};

/// Of the frames that both have. Positions in the camera's axes; each has its own shape, so a change of shape counts.
struct InitialiserGain {
  int frames = 0;
  MedianAndP95 joint_mm;      ///< of all joints but the root, after the root joints have been laid on each other
  MedianAndP95 root_mm;       ///< of the root joint itself; NaN under weak perspective, where it has no place
  MedianAndP95 rotation_deg;  ///< angle between the rotations of a joint against its parent, of all joints but the root
  MedianAndP95 root_deg;      ///< the same of the root
  int landmarks = 0;          ///< 2D joints of confidence above 0.3 that both have in front of their camera
  MedianAndP95 initialiser_px, fit_px;  ///< distance of these 2D joints to where they are detected
};

/// `initialiser` has as many frames as `fit`, those that it lacks NaN, and is meant in `initialiser_camera`;
/// `keypoints` may be null, or share no landmark with the body: then there is nothing in the image. Throws
/// std::invalid_argument for another number of frames.
InitialiserGain GainOverInitialiser(const BodyModel& body, const KeypointSequence* keypoints, const Motion& initialiser,
                                    const Camera& initialiser_camera, const Track& fit);

/// The same of a start that gives landmarks (T of 21×3 in the frame of `camera`, LifterPointNames(); without rows:
/// none): joint_mm is of these landmarks, the middles of the hips laid on each other and root_mm that of the middles;
/// nothing turns.
InitialiserGain GainOverLandmarks(const BodyModel& body, const KeypointSequence* keypoints,
                                  const std::vector<MatrixX3d>& landmarks, const Camera& camera, const Track& fit);

}  // namespace bodyloom
