// SPDX-License-Identifier: Apache-2.0
/// The clothes parser: a small convolutional network that says of each pixel of a person in a photo what it shows: top,
/// bottom, face, hair, skin or shoes. These are its numbers; neural/parser trains it, pipelines/person runs it. What it
/// brings: docs/lab/clothes_parser.md.
///
/// It reads the planes of PersonPlane (render/person/person_layers.h): the photo's colours, 0 where the person
/// is not, the person's mask as alpha, and of the bare body that was fitted, where it covers the mask, the normal and the
/// place at rest. It answers with a number a class; the largest is the class.
#pragma once

#include <string>

#include "bodyloom/render/person/person_layers.h"
#include "bodyloom/render/person/picture_unet.h"

namespace bodyloom {

/// Classes in the order of PersonLabel (geometry/person_label.h), from kTop to kShoes.
inline constexpr int kParserClasses = 6;
inline constexpr PictureUnetPlanes kParserPlanes = {PersonPlane::kCount, kParserClasses};

struct ParserWeights {
  PictureUnetWeights network;     ///< of kParserPlanes
  double pixels_per_metre = 250;  ///< how large people were that it learned from, the median picture
  std::string recipe;             ///< how they were learned, JSON

  /// Whether the network is valid and people had a size; `why` may be nullptr.
  bool IsValid(std::string* why) const;
};

}  // namespace bodyloom
