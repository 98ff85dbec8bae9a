// SPDX-License-Identifier: Apache-2.0
/// Body parts of the one-photo renderers, and the pose map P of the pose-guided one: the visible part of the bare body
/// at each pixel, as a colour.
///
/// DensePose's 24 charts become 14 parts: torso, head, and on either side hand, foot, thigh, shin, upper arm, forearm.
/// Fronts and backs share a part, as in the method's data set (3DPeople), whose colours are not public; these are
/// corners and edge centres of the RGB cube, at mutual distances of at least half its side.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bodyloom {

inline constexpr int kBodyParts = 15;  ///< with the background, part 0

/// Part of DensePose's chart 0–24.
int BodyPartOf(int chart);
inline constexpr int kLimbs = 9, kHeadLimb = 2;
/// Part without distinction of left and right: 0 background, 1 torso, 2 head, 3 hands, 4 feet, 5 thighs, 6 shins, 7
/// upper arms, 8 forearms.
int LimbOf(int chart);

/// RGB in [0, 1]; black for the background.
std::array<float, 3> BodyPartColour(int part);

/// Charts of n pixels → 3 × n planar RGB. Throws std::invalid_argument for a chart above 24.
std::vector<float> BodyPartMap(std::span<const uint8_t> charts);

struct HeadTexels {
  std::vector<uint8_t> head;  ///< U × U: 1 for texels of the head
  std::vector<uint8_t> back;  ///< U × U: 1 for texels behind the middle of the head's depth
};

/// `texel_parts`: U × U, DensePose's part; `texel_places`: planar 3 × U × U, positions of texels in the rest pose (z to
/// the front). Throws std::invalid_argument for sizes that do not fit and parts above 24.
HeadTexels HeadTexelsOf(std::span<const uint8_t> texel_parts, std::span<const float> texel_places);

}  // namespace bodyloom
