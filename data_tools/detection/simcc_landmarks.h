// SPDX-License-Identifier: Apache-2.0
/// What RTMPose says about a person's crop: decoding of its two outputs ("SimCC").
///
/// For each of K landmarks the network gives one score a column and one a row of the crop, r to a pixel (r = 2 in all
/// published networks): K × r·width and K × r·height numbers. A landmark lies where each is largest, at
///   place = (largest column, largest row) / r   in pixels of the crop (TopDownCrop()),
/// and its confidence is the smaller of the two largest scores, which is about 1 where the network is sure; where that
/// is not positive there is no landmark.
/// Source: MMPose, codecs/simcc_label.py and codecs/utils/post_processing.py (get_simcc_maximum).
#pragma once

#include <span>
#include <vector>

#include "bodyloom/data_tools/detection/picture_crop.h"
#include "bodyloom/geometry/observations.h"

namespace bodyloom {

/// K landmarks in pixels of the image, confidences limited to 1. Throws std::invalid_argument for other numbers of scores.
std::vector<Keypoint> DecodeSimcc(std::span<const float> columns, std::span<const float> rows, int landmarks,
                                  int per_pixel, const PictureCrop& crop);

}  // namespace bodyloom
