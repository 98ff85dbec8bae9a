// SPDX-License-Identifier: Apache-2.0
/// How true a track is in the world, where the camera moves: not in each picture, but from the clip's beginning to its
/// end.
///
/// Joints of track and truth in their scenes (geometry/scene/camera_path.h; that of a track without a path is its
/// camera frame, which is what it claims), one rigid motion for the clip, no scale, found
///   w_mpjpe_mm       on the first second's joints: what has drifted away since (W-MPJPE; WHAM and SLAHMR align the
///                    first two frames of every 100, by a similarity)
///   wa_mpjpe_mm      on all joints (WA-MPJPE)
///   root_drift_percent   mean distance of the pelvises after the latter, in percent of the true pelvis' way (RTE)
///   foot_slide_mps   mean speed of the track's ankles in frames in which the true ones move at less than 0.1 m/s
/// Frames without a result are left out.
#pragma once

#include "data_tools/evaluation/evaluation.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct WorldDrift {
  double w_mpjpe_m = 0, wa_mpjpe_m = 0;
  double root_drift = 0;      ///< a share; NaN when the true pelvis does not move
  double foot_slide_mps = 0;  ///< NaN when no true foot stands
};

/// Both tracks on `body`, of the same frames (checked).
WorldDrift MeasureWorldDrift(const Track& track, const Track& truth, const BodyModel& body);

/// The same as entries of an evaluation.
void AddWorldDrift(const WorldDrift& drift, Evaluation* evaluation);

}  // namespace bodyloom
