// SPDX-License-Identifier: Apache-2.0
/// Reads DensePose part labels, or a mask of the person, of a whole clip from one .npz: key `labels`, uint8 or other
/// integers or booleans, T×H×W, 0 = background, 1..24 = parts; optional `timestamps` (T, seconds) and `label_kind`, the
/// text "densepose" or "person": then 1 is the person, and PartLabelSequence::AsMask() has been applied to the result.
/// Without `label_kind`, labels are a mask if 1, or 255, is the only one beside 0, else DensePose's. 255 is the person
/// of a mask whose only label it is. A mask may be stored as runs (mask_runs.h) in place of `labels`, as written by
/// this project.
#pragma once

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

}  // namespace bodyloom
