// SPDX-License-Identifier: Apache-2.0
/// Renders one pose from the features of a source. Internal: includes LibTorch.
#pragma once

#include "neural/base/person_picture.h"
#include "neural/photo/photo_model.h"

namespace bodyloom {

/// `features`: 1×C×U×U as PhotoModelImpl::Complete gives them. Only the window within `reach` of the body is computed,
/// the rest is background; a negative reach computes the whole frame. A frame without a body is background. No
/// gradients.
PersonPicture RenderPhoto(PhotoModel model, const torch::Tensor& features, const PhotoFrame& pose, int reach);

}  // namespace bodyloom
