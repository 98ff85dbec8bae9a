// SPDX-License-Identifier: Apache-2.0
/// A clip's masks as runs of pixels, in arrays of an .npz: a person of 900 pixels takes 10 KB a frame, where pictures
/// of 1920×1080 take 2 MB.
///
///   mask_runs   int32 (R): lengths of runs of pixels, in the rows of a frame's box one after the other, by turns
///   without
///               and with the person, beginning without; frame after frame
///   mask_count  int32 (T): how many of them are of each frame
///   mask_box    int32 (T, 4): x, y, width, height in pixels; width 0: nobody was seen
///   image_size  int32 (2): width, height
#pragma once

#include <cstdint>
#include <string>

#include "data_tools/formats/npz.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

/// Of an image whose labels or masks are read.
constexpr int64_t kMostLabelPixelsASide = 32768;

/// The four arrays of masks: a pixel shows the person where its label is not 0. Throws std::invalid_argument when a
/// rectangle leaves the image, or has more than 67 megapixels.
NpzArrays MaskRuns(const PartLabelSequence& mask);

/// Whether an archive holds masks as runs.
bool HasMaskRuns(const NpzArrays& arrays);

/// Frames and image size, labels 0 and 1; without timestamps. Throws std::runtime_error naming `where`, the array, and
/// what was expected of which frame; before memory is taken, where boxes are too large for the runs that fill them.
PartLabelSequence MaskFromRuns(const NpzArrays& arrays, const std::string& where);

}  // namespace bodyloom
