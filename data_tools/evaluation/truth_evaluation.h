// SPDX-License-Identifier: Apache-2.0
/// Evaluates a track against a known truth: synthetic clips, whose body, pose, shape and camera are known.
#pragma once

#include "data_tools/evaluation/evaluation.h"
#include "data_tools/evaluation/vertex_errors.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Protocol "known-truth". Frame t of the track is compared with frame t of the truth, both posed on `body`, each seen
/// through its own camera. A frame without a result (non-finite parameters) is scored with the nearest frame that has
/// one. Values: per-vertex projection error (data_tools/evaluation/metrics_image.h), PVE, MPJPE (pelvis aligned, raw
/// and with one clip scale), PA-MPJPE, acceleration error, jitter, joint angles (of
/// OpenSim's coordinates too, data_tools/evaluation/joint_angle_errors.h), root error, shape error in the rest
/// pose, focal length. Millimetres, pixels, degrees, SI otherwise. Throws std::invalid_argument when the frame counts
/// differ, there are no frames, or a pose does not fit the body.
Evaluation EvaluateAgainstTruth(const Track& track, const Track& truth, const BodyModel& body,
                                const VertexErrorOptions& options = {});

}  // namespace bodyloom
