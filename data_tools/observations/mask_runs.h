// SPDX-License-Identifier: Apache-2.0
/// A clip's masks as runs of pixels, in arrays of an .npz: a person 900 pixels tall takes 10 KB per frame, a 1920×1080
/// image 2 MB.
///
///   mask_runs   int32 (R): lengths of runs of pixels in row-major order of a frame's box, alternately without and with
///               the person, beginning without; frame after frame
///   mask_count  int32 (T): number of runs of each frame
///   mask_box    int32 (T, 4): x, y, width, height in pixels; width 0: nobody was detected
///   image_size  int32 (2): width, height
#pragma once

#include <cstdint>
#include <string>

#include "data_tools/formats/npz.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

/// Maximum side of an image whose labels or masks are read.
constexpr int64_t kMaxLabelPixelsASide = 32768;

/// Returns the four arrays of the masks: a pixel shows the person if its label is not 0. Throws std::invalid_argument
/// if a rectangle extends beyond the image or has more than 67 megapixels.
NpzArrays MaskRuns(const PartLabelSequence& mask);

/// Returns true if an archive holds masks as runs.
bool HasMaskRuns(const NpzArrays& arrays);

/// Reads frames and image size, with labels 0 and 1, without timestamps. Throws std::runtime_error naming `where`, the
/// array, the frame and what was expected; before allocating memory if boxes are too large for their runs.
PartLabelSequence MaskFromRuns(const NpzArrays& arrays, const std::string& where);

}  // namespace bodyloom
