// SPDX-License-Identifier: Apache-2.0
/// The architecture card of the one-photo renderer: every network's parameters, shapes and multiply–adds, as text.
#pragma once

#include <string>

#include "bodyloom/neural/photo/photo_config.h"

namespace bodyloom {

/// A section a network (neural/networks/architecture_card.h): FeatureNet of a photo's texture, RenderNet of one frame
/// of the profile's whole image, the discriminators of a picture in training. A variant has those that it is made of.
std::string PhotoCard(const PhotoConfig& config);

}  // namespace bodyloom
