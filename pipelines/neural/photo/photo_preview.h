// SPDX-License-Identifier: Apache-2.0
/// Pictures to judge a run of the one-photo renderer by.
#pragma once

#include <vector>

#include "bodyloom/neural/photo/train_photo.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

/// A row a pair: the source picture, what it shows of the texture, the completed texture, the true target, the result.
Image PhotoPreviewSheet(const std::vector<PhotoPreview>& previews);

}  // namespace bodyloom
