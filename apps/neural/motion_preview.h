// SPDX-License-Identifier: Apache-2.0
/// Pictures to judge a run of the motion-dependent renderer by.
#pragma once

#include <span>
#include <vector>

#include "bodyloom/neural/motion/train_motion.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

/// Planar RGB in [0, 1] to a picture; values beyond are cut off.
Image PictureOf(std::span<const float> planar, int width, int height);

/// Normals of the camera frame as colours: red right, green up, blue towards the viewer; black where there are none.
Image NormalPicture(std::span<const float> planar, int width, int height);

Image LabelsPicture(std::span<const uint8_t> labels, int width, int height);

/// A row a frame: truth and result of the image, then of labels and normals where there are any.
Image MotionPreviewSheet(const std::vector<MotionPreview>& previews);

}  // namespace bodyloom
