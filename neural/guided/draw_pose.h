// SPDX-License-Identifier: Apache-2.0
/// Renders one pose through the three networks. Internal: includes LibTorch.
#pragma once

#include "neural/guided/coherent_maps.h"
#include "neural/guided/guided_model.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// The networks see the box of cells that the body, grown by `reach` pixels, lies in; what is farther from the body
/// than that is background. reach 0: the whole window. An empty picture where the frame shows no body. `share` (may be
/// null): of the window that was computed.
PersonPicture DrawGuided(GuidedModel* model, const GuidedSource& source, const PhotoFrame& frame,
                         const PseudoPicture& pseudo, int reach, double* share);

}  // namespace bodyloom
