// SPDX-License-Identifier: Apache-2.0
/// Refines the masks of a clip from a static camera by segmentation against the estimated background
/// (tracking/detection/background_cut.h).
#pragma once

#include "geometry/base/callbacks.h"
#include "pipelines/detect/detect_people.h"

namespace bodyloom {

/// Refines all masks of `clip`, the result of DetectPeople() for this request, in two more passes through the video.
/// Returns false and leaves the masks unchanged if refinement is not possible: no masks, fewer than a dozen frames, a
/// moving camera, or people who always cover half of the image. Frames whose background cannot be recognised keep their
/// masks; if they are more than a fifth, all masks are kept. Frames are processed in parallel; the result does not
/// depend on `threads` (0: all cores). Throws std::runtime_error naming a video that cannot be read again, Cancelled.
bool CutMasks(const DetectPeopleRequest& request, int threads, DetectedClip* clip,
              const PipelineCallbacks& callbacks = {});

/// Text that says whether CutMasks() refined the masks.
const char* MasksText(bool cut);

}  // namespace bodyloom
