// SPDX-License-Identifier: Apache-2.0
/// Pictures to judge the pose-guided renderer by.
#pragma once

#include <span>

#include "neural/guided/coherent_maps.h"
#include "render/image/image.h"

namespace bodyloom {

/// Appearance, labels and where texels are from (photos in greys, what was made up in colours, empty black); below, the
/// virtual views' pictures, then their labels.
Image GuidedMapsSheet(const CoherentMaps& maps, std::span<const PersonPicture> virtual_pictures, int num_photos);

}  // namespace bodyloom
