// SPDX-License-Identifier: Apache-2.0
/// A stretch of a clip's observations.
#pragma once

#include "bodyloom/geometry/observations.h"

namespace bodyloom {

/// Frames [first, last], both included, with their timestamps as they are. Throws std::invalid_argument for frames that
/// are not there.
KeypointSequence CutFrames(KeypointSequence keypoints, int first, int last);
PartLabelSequence CutFrames(PartLabelSequence labels, int first, int last);

}  // namespace bodyloom
