// SPDX-License-Identifier: Apache-2.0
/// Evaluates a track against part labels of the same video: overlap of the rendered body with the person, and of each
/// part.
#pragma once

#include "data_tools/evaluation/evaluation.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct EvaluatePartLabelsOptions {
  int min_pixels = 400;  ///< a part is scored in a frame if its label has at least as many pixels
};

/// Protocol "part-labels". The body of every frame is rendered (visibility buffer, back faces culled) and each pixel
/// takes its face's chart. Values: mean and lowest decile over frames of silhouette IoU; mean over (frame, part) pairs
/// with enough label pixels of part IoU |A∩B| / |A∪B|, with all 24 charts, and with the charts of a limb's bone joined;
/// the share of the person's pixels with the right label. Breakdown by chart. Frames without labels are left out;
/// frames without a result count with IoU 0.
/// Throws std::invalid_argument when the frame counts or image sizes differ or the body has no parts.
Evaluation EvaluatePartLabels(const Track& track, const PartLabelSequence& labels, const BodyModel& body,
                              const EvaluatePartLabelsOptions& options = {});

}  // namespace bodyloom
