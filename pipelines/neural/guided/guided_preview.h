// SPDX-License-Identifier: Apache-2.0
/// Pictures to judge the pose-guided renderer by.
#pragma once

#include <span>
#include <vector>

#include "neural/guided/coherent_maps.h"
#include "neural/guided/train_guided.h"
#include "render/image/image.h"

namespace bodyloom {

/// A row a picture: source, what is known of the target, result and truth, then labels known, made and true.
Image GuidedPreviewSheet(const std::vector<GuidedPreview>& previews);

/// Appearance, labels and where texels are from (photos in greys, what was made up in colours, empty black); below, the
/// virtual views' pictures, then their labels.
Image GuidedMapsSheet(const CoherentMaps& maps, std::span<const GuidedPicture> virtual_pictures, int num_photos);

}  // namespace bodyloom
