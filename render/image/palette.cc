// SPDX-License-Identifier: Apache-2.0
#include "render/image/palette.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {

Colour PersonColour(int number) {
  static constexpr std::array<Colour, 6> kColours = {
      {kBodyColour, {232, 190, 96}, {178, 92, 112}, {150, 212, 158}, {120, 84, 170}, {226, 156, 208}}};
  return kColours[size_t(std::max(0, number)) % kColours.size()];
}

Colour PartColour(int part) {
  static constexpr std::array<Colour, 25> kColours = {{
      {150, 150, 150},                   // none
      {124, 110, 170}, {172, 158, 214},  // torso back, front
      {64, 190, 190},  {250, 180, 70},   // right, left hand
      {250, 200, 110}, {100, 205, 200},  // left, right foot
      {48, 96, 176},   {200, 74, 66},    // upper legs, back: right, left
      {84, 140, 222},  {238, 112, 96},   // upper legs, front
      {46, 122, 160},  {206, 104, 52},   // lower legs, back
      {84, 170, 208},  {246, 146, 86},   // lower legs, front
      {236, 96, 120},  {92, 120, 214},   // upper arms, front: left, right
      {196, 64, 92},   {62, 84, 170},    // upper arms, back
      {248, 136, 148}, {112, 160, 232},  // lower arms, front
      {212, 96, 112},  {74, 120, 190},   // lower arms, back
      {126, 200, 160}, {214, 212, 120},  // head: right, left half
  }};
  return kColours[part >= 1 && part <= 24 ? part : 0];
}

Colour ClothesColour(int part) {
  constexpr Colour kSkin{224, 178, 148}, kShirt{196, 84, 72}, kTrousers{70, 84, 112}, kShoes{58, 56, 60};
  if (part == 1 || part == 2 || (part >= 15 && part <= 18)) return kShirt;
  if (part >= 7 && part <= 14) return kTrousers;
  if (part == 5 || part == 6) return kShoes;
  return kSkin;
}

ChannelTriple MedianColour(std::span<const ChannelTriple> colours) {
  BODYLOOM_CHECK(!colours.empty(), "median colour: of no colour");
  ChannelTriple median{};
  std::vector<float> values(colours.size());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  for (size_t c = 0; c < median.size(); ++c) {
    std::transform(colours.begin(), colours.end(), values.begin(), [c](const ChannelTriple& v) { return v[c]; });
    std::nth_element(values.begin(), middle, values.end());
    median[c] = *middle;
    if (values.size() % 2 == 0) median[c] = (median[c] + *std::max_element(values.begin(), middle)) / 2;
  }
  return median;
}

std::optional<ChannelTriple> MedianColourOfMany(std::span<const ChannelTriple> colours, size_t fewest) {
  if (colours.size() < fewest) return std::nullopt;
  return MedianColour(colours);
}

}  // namespace bodyloom
