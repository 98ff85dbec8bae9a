// SPDX-License-Identifier: Apache-2.0
/// Accuracy of a track in the world when the camera moves: not per image, but from the beginning to the end of the
/// clip.
///
/// Joints of track and truth in their scenes (geometry/scene/camera_path.h; for a track without a path, its camera
/// frame), after one rigid motion for the clip, without scale, fitted
///   w_mpjpe_mm       on the first second's joints: drift since then (W-MPJPE; WHAM and SLAHMR align the
///                    first two frames of every 100, by a similarity)
///   wa_mpjpe_mm      on all joints (WA-MPJPE)
///   root_drift_percent   mean distance of the pelvises after the latter, in percent of the true pelvis' path (RTE)
///   w_mpjpe_100_mm, wa_mpjpe_100_mm, rte_percent   as EMDB defines them (global_errors.h)
///   foot_slide_mps   mean speed of the track's ankles in frames in which the true ones move at less than 0.1 m/s
/// Frames without a result are left out.
#pragma once

#include "data_tools/evaluation/evaluation.h"
#include "data_tools/evaluation/global_errors.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct WorldDrift {
  double w_mpjpe_m = 0, wa_mpjpe_m = 0;
  double root_drift = 0;      ///< a share; NaN if the true pelvis does not move
  double foot_slide_mps = 0;  ///< NaN if no true foot is stationary
  GlobalErrors emdb;          ///< of all joints; roots: the pelvis
};

/// Both tracks on `body` (the truth on `true_body`, if it is another one with the same joints) and of the same frames
/// (checked).
WorldDrift MeasureWorldDrift(const Track& track, const Track& truth, const BodyModel& body,
                             const BodyModel* true_body = nullptr);

/// The same as entries of an evaluation.
void AddWorldDrift(const WorldDrift& drift, Evaluation* evaluation);

}  // namespace bodyloom
