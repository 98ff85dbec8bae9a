// SPDX-License-Identifier: Apache-2.0
/// Masks of a clip whose camera stands still, cut anew from what stands behind the people
/// (tracking/detection/background_cut.h).
#pragma once

#include "geometry/base/callbacks.h"
#include "pipelines/detect/detect_people.h"

namespace bodyloom {

/// Cuts all masks of `clip`, which DetectPeople() found by this request, in two more passes through the video. False,
/// and masks as they were, where nothing can be gained: no masks, fewer than a dozen frames, a camera that moves, or
/// people who cover half of the picture all the time. A frame in which the background cannot be recognised keeps its
/// masks; more than a fifth of such frames, and all masks stay. Frames are cut side by side; masks do not depend on
/// `threads` (0: all cores). Throws std::runtime_error naming a video that cannot be read again, Cancelled.
bool CutMasks(const DetectPeopleRequest& request, int threads, DetectedClip* clip,
              const PipelineCallbacks& callbacks = {});

/// What CutMasks() did, for a reader.
const char* MasksText(bool cut);

}  // namespace bodyloom
