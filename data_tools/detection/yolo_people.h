// SPDX-License-Identifier: Apache-2.0
/// What YOLOv8, YOLO11 and their pose networks say about a picture: decoding of their output.
///
/// For N places ("anchors") of a letterboxed picture (LetterboxCrop()) the output holds rows × N numbers, each row
/// together: x and y of a box's middle, its width and height in pixels of the letterbox; one score a class, 0 to 1; then,
/// of a pose network, x, y and visibility (0 to 1) of each landmark. Pose networks know one class, a person; of networks
/// with more, class 0 is the person (COCO's order), and an anchor counts when no other class is surer.
/// Boxes that overlap a surer one (intersection over union above 0.7) are left out, as are scores below ¼ and all but the
/// 300 surest: the defaults of the networks' own program.
/// Source: Ultralytics, nn/modules/head.py and utils/ops.py (non_max_suppression).
#pragma once

#include <span>
#include <vector>

#include "bodyloom/data_tools/detection/picture_crop.h"
#include "bodyloom/geometry/observations.h"

namespace bodyloom {

struct YoloPerson {
  PersonBox box;                 ///< pixels of the image
  std::vector<Keypoint> points;  ///< pixels of the image; confidence is the visibility, 0 where a number is not finite
};

/// The people, surest first. Throws std::invalid_argument for other than (4 + classes + 3 · landmarks) · N numbers.
std::vector<YoloPerson> DecodeYolo(std::span<const float> output, int classes, int landmarks, const PictureCrop& crop);

}  // namespace bodyloom
