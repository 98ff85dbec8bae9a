// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/guess_unseen.h"

#include <algorithm>

#include "geometry/base/check.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {
namespace {

bool Has(std::span<const uint8_t> labels, uint8_t label) {
  return std::find(labels.begin(), labels.end(), label) != labels.end();
}

/// The most frequent label of the nearest seen texels, by texel.
std::vector<uint8_t> NearestLabels(const TexelNeighbours& neighbours, std::span<const uint8_t> labels) {
  const size_t texels = labels.size();
  std::vector<float> shares(kPhotoLabels * texels);
  for (size_t i = 0; i < texels; ++i) {
    if (labels[i] != 0) shares[labels[i] * texels + i] = 1;
  }
  neighbours.FillUnseen(labels, kPhotoLabels, shares);
  std::vector<uint8_t> nearest(texels);
  for (size_t i = 0; i < texels; ++i) {
    for (uint8_t k = 1; k < kPhotoLabels; ++k) {
      if (shares[k * texels + i] > shares[nearest[i] * texels + i]) nearest[i] = k;
    }
  }
  return nearest;
}

/// Copies `colours` of the nearest texels of `sources` to those of `wanted`; does nothing without sources.
void TakeColours(const TexelNeighbours& neighbours, std::span<const uint8_t> sources, std::span<const uint8_t> wanted,
                 std::span<float> colours) {
  const size_t texels = sources.size();
  if (!Has(sources, 1) || !Has(wanted, 1)) return;
  std::vector<float> nearest(colours.begin(), colours.end());
  neighbours.FillUnseen(sources, 3, nearest);
  for (size_t i = 0; i < texels; ++i) {
    if (wanted[i] == 0) continue;
    for (size_t c = 0; c < 3; ++c) colours[c * texels + i] = nearest[c * texels + i];
  }
}

}  // namespace

std::vector<uint8_t> GuessUnseen(const TexelNeighbours& neighbours, std::span<uint8_t> labels,
                                 std::span<float> colours) {
  const size_t texels = labels.size();
  BODYLOOM_CHECK(texels == neighbours.back_of_head().size() && colours.size() == 3 * texels, "guess: ", texels,
                 " labels and ", colours.size(), " colours, expected ", neighbours.back_of_head().size(),
                 " and three times as many");
  BODYLOOM_CHECK(std::all_of(labels.begin(), labels.end(), [](uint8_t label) { return label < kPhotoLabels; }),
                 "guess: a label above ", kPhotoLabels - 1);
  const std::vector<uint8_t> shown(labels.begin(), labels.end());
  const std::span<const uint8_t> behind = neighbours.back_of_head(), head = neighbours.head();
  const bool hair = Has(shown, kHairLabel);
  std::vector<uint8_t> faceless = shown;
  std::replace(faceless.begin(), faceless.end(), kFaceLabel, hair ? kHairLabel : kSkinLabel);
  std::vector<uint8_t> guess = NearestLabels(neighbours, shown);
  const std::vector<uint8_t> of_back = NearestLabels(neighbours, faceless);
  std::vector<uint8_t> guessed(texels);
  for (size_t i = 0; i < texels; ++i) {
    if (behind[i] != 0) guess[i] = of_back[i];
    guessed[i] = shown[i] == 0 && guess[i] != 0 ? 1 : 0;
  }
  for (uint8_t k = 1; k < kPhotoLabels; ++k) {
    std::vector<uint8_t> sources(texels), wanted(texels);
    for (size_t i = 0; i < texels; ++i) {
      sources[i] = shown[i] == k ? 1 : 0;
      wanted[i] = guessed[i] != 0 && guess[i] == k ? 1 : 0;
    }
    TakeColours(neighbours, sources, wanted, colours);
    if (k != kSkinLabel || hair) continue;
    for (size_t i = 0; i < texels; ++i) {
      sources[i] = head[i] != 0 && faceless[i] == k ? 1 : 0;
      wanted[i] = wanted[i] != 0 && behind[i] != 0 ? 1 : 0;
    }
    TakeColours(neighbours, sources, wanted, colours);
  }
  for (size_t i = 0; i < texels; ++i) {
    if (guessed[i] != 0) labels[i] = guess[i];
  }
  return guessed;
}

void RelabelBackOfHeadAsHair(std::span<const uint8_t> back_of_head, std::span<uint8_t> labels) {
  BODYLOOM_CHECK(back_of_head.size() == labels.size(), "labels of the back of the head: ", labels.size(), ", expected ",
                 back_of_head.size());
  if (Has(labels, kHairLabel)) return;
  for (size_t i = 0; i < labels.size(); ++i) {
    if (back_of_head[i] != 0 && labels[i] == kFaceLabel) labels[i] = kHairLabel;
  }
}

}  // namespace bodyloom
