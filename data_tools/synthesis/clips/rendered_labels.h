// SPDX-License-Identifier: Apache-2.0
/// Part labels of a known track: what a perfect detector would predict for every pixel.
#pragma once

#include "geometry/body/body_model.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Every pixel takes the chart of the face that the centre of its block of block_px × block_px pixels sees (1: its own
/// centre); a low-resolution detector's labels come in blocks. Frames without a result are empty.
/// Throws std::invalid_argument when the body has no parts, the camera no image size, or block_px < 1.
PartLabelSequence RenderPartLabels(const BodyModel& body, const Track& track, int block_px = 1);

}  // namespace bodyloom
