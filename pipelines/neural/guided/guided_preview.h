// SPDX-License-Identifier: Apache-2.0
/// Pictures for visual inspection of the pose-guided renderer.
#pragma once

#include <span>

#include "neural/guided/coherent_maps.h"
#include "render/image/image.h"

namespace bodyloom {

/// Appearance, labels and sources of the texels (photos in greys, synthesised ones in colours, empty black); below, the
/// images of the virtual views, then their labels.
Image GuidedMapsSheet(const CoherentMaps& maps, std::span<const RenderedPerson> virtual_images, int num_photos);

}  // namespace bodyloom
