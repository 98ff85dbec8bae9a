// SPDX-License-Identifier: Apache-2.0
/// Completes the coherent maps from six views of the body in T-pose, each rendered by the networks from the current
/// maps.
///
/// The back is rendered from the front, as clothes are mostly the same on both sides. Its pseudo inputs are patches of
/// the front's rendered image, mirrored (body box onto body box), the face replaced by hair (from the front, else from
/// the maps; by skin if no hair is seen). Texels that only the back view sees never get a face; if a network renders a
/// face on the back where its input was hair, the hair is kept. Source: Yoon et al., CVPR 2021, Section 3.2 and Fig. 7.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "neural/guided/coherent_maps.h"

namespace bodyloom {

enum VirtualView { kViewFront, kViewBack, kViewLeft, kViewRight, kViewTop, kViewBottom, kNumVirtualViews };

/// Renders a pose from its pseudo inputs.
using DrawPose = std::function<RenderedPerson(const PhotoFrame& frame, const PseudoImage& pseudo)>;

/// Mask of the texels that only the back view sees.
std::vector<uint8_t> TexelsOfTheBack(const PhotoFrame& front, const PhotoFrame& back);

/// Pseudo inputs of the back view. `maps`: source of hair colour behind the face if the image shows no hair.
PseudoImage MirroredFront(const PhotoFrame& front, const RenderedPerson& rendered, const PhotoFrame& back,
                          const CoherentMaps& maps);

/// Completes the maps. `views` in the order of VirtualView; filled texels are numbered first_number, first_number + 1,
/// … Returns the six images.
std::vector<RenderedPerson> CompleteMaps(std::span<const PhotoFrame> views, const DrawPose& draw, int first_number,
                                         CoherentMaps* maps);

}  // namespace bodyloom
