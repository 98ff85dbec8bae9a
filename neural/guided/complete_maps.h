// SPDX-License-Identifier: Apache-2.0
/// Completes the coherent maps over six views of the body in T-pose, each drawn by the networks from the maps as they
/// are so far.
///
/// The back is drawn from the front: nothing is known of it, but clothes are mostly the same on both sides. Its pseudo
/// inputs are patches of the front's finished picture, mirrored (body box onto body box), the face replaced by hair
/// (the front's, else what the maps have; by skin where no hair is seen). Texels that only the back view sees never
/// show a face, whoever fills them; where a network paints one on the back although it was given hair, the hair stays.
/// Source: Yoon et al., CVPR 2021, Section 3.2 and Fig. 7.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "neural/guided/coherent_maps.h"

namespace bodyloom {

enum VirtualView { kViewFront, kViewBack, kViewLeft, kViewRight, kViewTop, kViewBottom, kNumVirtualViews };

/// Draws a pose from its pseudo inputs.
using DrawPose = std::function<PersonPicture(const PhotoFrame& frame, const PseudoPicture& pseudo)>;

/// Texels that the back view sees and the front view does not.
std::vector<uint8_t> TexelsOfTheBack(const PhotoFrame& front, const PhotoFrame& back);

/// Pseudo inputs of the back view. `maps`: whose hair stands behind the face where the picture shows none.
PseudoPicture MirroredFront(const PhotoFrame& front, const PersonPicture& picture, const PhotoFrame& back,
                            const CoherentMaps& maps);

/// `views` in the order of VirtualView; texels are marked first_number, first_number + 1, … Returns the six pictures.
std::vector<PersonPicture> CompleteMaps(std::span<const PhotoFrame> views, const DrawPose& draw, int first_number,
                                        CoherentMaps* maps);

}  // namespace bodyloom
