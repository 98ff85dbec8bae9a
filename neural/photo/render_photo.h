// SPDX-License-Identifier: Apache-2.0
/// Renders one pose from the features of a source. Internal: includes LibTorch.
#pragma once

#include "neural/base/rendered_person.h"
#include "neural/photo/photo_model.h"

namespace bodyloom {

/// `features`: 1×C×U×U from PhotoModelImpl::Complete. Only the window within `reach` of the body is computed, the rest
/// is background; a negative reach computes the whole frame. A frame without a body gives background. No gradients.
RenderedPerson RenderPhoto(PhotoModel model, const torch::Tensor& features, const PhotoFrame& pose, int reach);

}  // namespace bodyloom
