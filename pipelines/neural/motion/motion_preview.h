// SPDX-License-Identifier: Apache-2.0
/// Pictures to judge a run of the motion-dependent renderer by.
#pragma once

#include <vector>

#include "bodyloom/neural/motion/train_motion.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

/// A row a frame: truth and result of the image, then of labels and normals where there are any.
Image MotionPreviewSheet(const std::vector<MotionPreview>& previews);

}  // namespace bodyloom
