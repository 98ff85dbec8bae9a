// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/body_part_map.h"

#include <algorithm>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

enum Part : uint8_t {
  kNone,
  kTorso,
  kHead,
  kHandR,
  kHandL,
  kFootL,
  kFootR,
  kThighR,
  kThighL,
  kShinR,
  kShinL,
  kUpperArmL,
  kUpperArmR,
  kForearmL,
  kForearmR
};

// DensePose's numbering: torso back and front; hands right, left; feet left, right; thighs and shins right, left (back,
// then front); upper arms and forearms left, right (inside, then outside); head right, left.
constexpr std::array<uint8_t, 25> kPartOfChart = {
    kNone,      kTorso,    kTorso,    kHandR,    kHandL,    kFootL, kFootR,     kThighR,    kThighL,
    kThighR,    kThighL,   kShinR,    kShinL,    kShinR,    kShinL, kUpperArmL, kUpperArmR, kUpperArmL,
    kUpperArmR, kForearmL, kForearmR, kForearmL, kForearmR, kHead,  kHead};

constexpr std::array<std::array<float, 3>, kBodyParts> kColours = {{{0, 0, 0},
                                                                    {1, 1, 1},
                                                                    {1, 1, 0},
                                                                    {1, 0, 0},
                                                                    {0, 0, 1},
                                                                    {0, 1, 1},
                                                                    {1, 0, 1},
                                                                    {1, 0.5F, 0},
                                                                    {0, 0.5F, 1},
                                                                    {0.5F, 0, 0},
                                                                    {0, 0, 0.5F},
                                                                    {0, 1, 0.5F},
                                                                    {1, 0, 0.5F},
                                                                    {0, 1, 0},
                                                                    {0.5F, 0, 1}}};

}  // namespace

int BodyPartOf(int chart) {
  BODYLOOM_CHECK(chart >= 0 && chart < static_cast<int>(kPartOfChart.size()), "body part map: chart ", chart,
                 ", expected 0 to 24");
  return kPartOfChart[chart];
}

int LimbOf(int chart) {
  const int part = BodyPartOf(chart);
  return part < kHandR ? part : kHandR + (part - kHandR) / 2;  // from the hands on, parts form left–right pairs
}

std::array<float, 3> BodyPartColour(int part) {
  BODYLOOM_CHECK(part >= 0 && part < kBodyParts, "body part map: part ", part, ", expected 0 to ", kBodyParts - 1);
  return kColours[part];
}

std::vector<float> BodyPartMap(std::span<const uint8_t> charts) {
  std::vector<float> map(3 * charts.size());
  for (size_t i = 0; i < charts.size(); ++i) {
    const std::array<float, 3>& colour = kColours[BodyPartOf(charts[i])];
    for (size_t c = 0; c < 3; ++c) map[c * charts.size() + i] = colour[c];
  }
  return map;
}

HeadTexels HeadTexelsOf(std::span<const uint8_t> texel_parts, std::span<const float> texel_places) {
  const size_t texels = texel_parts.size();
  BODYLOOM_CHECK(texel_places.size() == 3 * texels, "head: ", texel_places.size(), " places of ", texels, " texels");
  HeadTexels result = {std::vector<uint8_t>(texels), std::vector<uint8_t>(texels)};
  const std::span<const float> depth = texel_places.subspan(2 * texels);
  float front = std::numeric_limits<float>::lowest(), back = std::numeric_limits<float>::max();
  for (size_t k = 0; k < texels; ++k) {
    if (LimbOf(texel_parts[k]) != kHeadLimb) continue;
    result.head[k] = 1;
    front = std::max(front, depth[k]), back = std::min(back, depth[k]);
  }
  for (size_t k = 0; k < texels; ++k) {
    result.back[k] = result.head[k] != 0 && depth[k] < 0.5 * (double(front) + back) ? 1 : 0;
  }
  return result;
}

}  // namespace bodyloom
