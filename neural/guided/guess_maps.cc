// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/guided/guess_maps.h"

#include <algorithm>
#include <vector>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

/// The commonest label of the nearest filled texels, by texel.
std::vector<uint8_t> NearestLabels(const TexelNeighbours& neighbours, std::span<const uint8_t> filled,
                                   std::span<const uint8_t> labels) {
  const size_t texels = filled.size();
  std::vector<float> shares(kPhotoLabels * texels);
  for (size_t i = 0; i < texels; ++i) {
    if (filled[i] != 0) shares[labels[i] * texels + i] = 1;
  }
  neighbours.FillUnseen(filled, kPhotoLabels, shares);
  std::vector<uint8_t> nearest(texels);
  for (size_t i = 0; i < texels; ++i) {
    for (uint8_t k = 1; k < kPhotoLabels; ++k) {
      if (shares[k * texels + i] > shares[nearest[i] * texels + i]) nearest[i] = k;
    }
  }
  return nearest;
}

}  // namespace

int GuessRest(const TexelNeighbours& neighbours, uint8_t from, CoherentMaps* maps) {
  const size_t texels = maps->from.size();
  BODYLOOM_CHECK(from > 0 && neighbours.texture_size() == maps->size, "coherent maps: neighbours of ",
                 neighbours.texture_size(), " texels a side for maps of ", maps->size);
  std::vector<uint8_t> filled(texels);
  for (size_t i = 0; i < texels; ++i) filled[i] = maps->from[i] != 0 ? 1 : 0;
  std::vector<uint8_t> guess = NearestLabels(neighbours, filled, maps->labels);
  const bool hair = std::find(maps->labels.begin(), maps->labels.end(), kHairLabel) != maps->labels.end();
  std::vector<uint8_t> faceless = maps->labels;
  std::replace(faceless.begin(), faceless.end(), kFaceLabel, hair ? kHairLabel : kSkinLabel);
  const std::vector<uint8_t> of_back = NearestLabels(neighbours, filled, faceless);
  for (size_t i = 0; i < texels; ++i) {
    if (neighbours.back_of_head()[i] != 0) guess[i] = of_back[i];
  }
  int count = 0;
  for (uint8_t k = 1; k < kPhotoLabels; ++k) {
    std::vector<uint8_t> of_label(texels);
    bool any = false;
    for (size_t i = 0; i < texels; ++i) {
      of_label[i] = filled[i] != 0 && maps->labels[i] == k ? 1 : 0;
      any = any || of_label[i] != 0;
    }
    std::vector<float> colours = maps->appearance;
    // Skin that nobody has seen has the colour of the nearest of everything: of the face it stands in for.
    neighbours.FillUnseen(any ? of_label : filled, 3, colours);
    for (size_t i = 0; i < texels; ++i) {
      if (filled[i] != 0 || maps->texel_parts[i] == 0 || guess[i] != k) continue;
      for (size_t c = 0; c < 3; ++c) maps->appearance[c * texels + i] = colours[c * texels + i];
      maps->labels[i] = k;
      maps->from[i] = from;
      ++count;
    }
  }
  return count;
}

}  // namespace bodyloom
