// SPDX-License-Identifier: Apache-2.0
/// Reads DensePose part labels, or a mask of the person, of a whole clip from one .npz: key `labels`, uint8 or other
/// integers or booleans, T×H×W, 0 = background, 1..24 = parts; optional `timestamps` (T, seconds) and `label_kind`, the
/// text "densepose" or "person": then 1 is the person, and PartLabelSequence::AsMask() has been applied to the result.
/// Without `label_kind`, labels are a mask if 1, or 255, is the only one beside 0, else DensePose's. 255 is the person
/// of a mask whose only label it is. A mask may be stored as runs in place of `labels`, as written by
/// this project.
#pragma once

#include <cstdint>
#include <string>

#include "data_tools/formats/npz.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

struct ReadPartLabelsOptions {
  double fps = 30;          ///< of a file without timestamps
  double min_share = 0.05;  ///< blobs smaller than this share of the largest one …
  double max_gap = 0.15;    ///< … and farther from it than this share of its box's longer side are not the person
  uint8_t highest_label = 24;
  /// Resized label images have lines of false labels between two parts, and specks. If true, regions thinner than 3 px
  /// take the most frequent label of their neighbours, or become unknown (255) if none has one.
  bool mend_strays = true;
};

/// Writes a mask as runs: a pixel shows the person if its label is not 0. Throws std::invalid_argument when frames and
/// timestamps differ in number or a rectangle extends beyond the image, std::runtime_error naming the path when it
/// cannot be written.
void WriteMask(const std::string& path, const PartLabelSequence& mask);

/// Returns true if an archive holds part labels.
bool HasPartLabels(const NpzArrays& arrays);

/// Reads each frame's labels, cropped to the person's box. Blobs of labels apart from the person (min_share, max_gap)
/// become background; `dropped_pixels`, when requested, counts them over the clip. Throws std::runtime_error naming the
/// file, the key, and what was expected: shape (also of height × width × frames), type, a label above highest_label
/// (with its frame and pixel), timestamps that do not increase.
PartLabelSequence ReadPartLabels(const std::string& path, const ReadPartLabelsOptions& options = {},
                                 int64_t* dropped_pixels = nullptr);
PartLabelSequence PartLabelsFromNpz(const NpzArrays& arrays, const std::string& where,
                                    const ReadPartLabelsOptions& options = {}, int64_t* dropped_pixels = nullptr);

// A clip's masks as runs of pixels, in arrays of an .npz: a person 900 pixels tall takes 10 KB per frame, a 1920×1080
// image 2 MB.
//
//   mask_runs   int32 (R): lengths of runs of pixels in row-major order of a frame's box, alternately without and with
//               the person, beginning without; frame after frame
//   mask_count  int32 (T): number of runs of each frame
//   mask_box    int32 (T, 4): x, y, width, height in pixels; width 0: nobody was detected
//   image_size  int32 (2): width, height

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
