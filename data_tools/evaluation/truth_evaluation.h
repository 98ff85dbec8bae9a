// SPDX-License-Identifier: Apache-2.0
/// A track against a known truth: synthetic clips, where body, pose, shape and camera are known.
#pragma once

#include "bodyloom/data_tools/evaluation/evaluation.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

struct EvaluateAgainstTruthOptions {
  int vertex_step = 1;      ///< every n-th vertex is compared (1: all); the mean moves by well under a percent up to 10
  int num_threads = 1;      ///< of skinning; the result is the same
  int image_side_px = 512;  ///< projection errors are for an image scaled to this by its longer side
};

/// Protocol "known-truth". Frame t of the track is compared with frame t of the truth, both posed on `body`, each seen
/// through its own camera. A frame without a result (non-finite parameters) is scored with the nearest frame that has
/// one. Values: per-vertex projection error (data_tools/evaluation/metrics_image.h), PVE, MPJPE (pelvis aligned, raw
/// and with one clip scale), PA-MPJPE, acceleration error, jitter, joint angles, root error, shape error in the rest
/// pose, focal length. Millimetres, pixels, degrees, SI otherwise. Throws std::invalid_argument when the frame counts
/// differ, there are no frames, or a pose does not fit the body.
Evaluation EvaluateAgainstTruth(const Track& track, const Track& truth, const BodyModel& body,
                                const EvaluateAgainstTruthOptions& options = {});

}  // namespace bodyloom
