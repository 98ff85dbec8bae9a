// SPDX-License-Identifier: Apache-2.0
/// The picture refiner: a small convolutional network that reads what was drawn of a person made from photos
/// (render/person/person_layers.h) and says how colour and alpha should change. These are its numbers; neural/refiner
/// trains it, pipelines/person runs it. What it brings: docs/lab/picture_refiner.md.
#pragma once

#include <string>

#include "bodyloom/render/person/person_layers.h"
#include "bodyloom/render/person/picture_unet.h"

namespace bodyloom {

inline constexpr PictureUnetPlanes kRefinerPlanes = {PersonPlane::kCount, 4};
static_assert(kLayersMultiple % kPictureUnetMultiple == 0);

struct RefinerWeights {
  PictureUnetWeights network;     ///< of kRefinerPlanes
  double pixels_per_metre = 250;  ///< how large people were that it learned from, the median picture
  bool moves_outline = false;     ///< whether it changes alpha; else colours alone
  std::string recipe;             ///< how they were learned, JSON

  /// Whether the network is valid and people had a size; `why` may be nullptr.
  bool IsValid(std::string* why) const;
};

}  // namespace bodyloom
