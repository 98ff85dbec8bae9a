// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/picture_refiner.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

RefinerWeights Checked(RefinerWeights weights) {
  std::string why;
  BODYLOOM_CHECK(weights.IsValid(&why), "picture refiner: ", why);
  return weights;
}

}  // namespace

PictureRefiner::PictureRefiner(RefinerWeights weights)
    : pixels_per_metre_(weights.pixels_per_metre),
      moves_outline_(weights.moves_outline),
      network_(Checked(std::move(weights)).network, kRefinerPlanes) {}

PictureRefiner PictureRefiner::Another() const {
  return PictureRefiner({network_.weights(), pixels_per_metre_, moves_outline_, ""});
}

std::vector<float> PictureRefiner::Change(const PersonLayers& layers) {
  std::vector<float> change = network_.Run(layers.width, layers.height, layers.planes);
  if (moves_outline_) {
    KeepNearOutline(layers, change);
  } else {
    std::fill(change.begin() + static_cast<std::ptrdiff_t>(PersonPlane::kAlpha * layers.pixels()), change.end(), 0.0F);
  }
  return change;
}

}  // namespace bodyloom
