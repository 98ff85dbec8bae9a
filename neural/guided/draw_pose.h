// SPDX-License-Identifier: Apache-2.0
/// Renders one pose through the three networks. Internal: includes LibTorch.
#pragma once

#include "neural/guided/coherent_maps.h"
#include "neural/guided/guided_model.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// The networks see the box of cells around the body grown by `reach` pixels; pixels farther from the body are
/// background. reach 0: the whole window. The image is empty if the frame shows no body. `share` (may be null):
/// computed share of the window.
RenderedPerson DrawGuided(GuidedModel* model, const GuidedSource& source, const PhotoFrame& frame,
                          const PseudoImage& pseudo, int reach, double* share);

}  // namespace bodyloom
