// SPDX-License-Identifier: Apache-2.0
/// Parts of the body as the one-photo renderers distinguish them, and the pose map P of the pose-guided one: which part
/// of the undressed body a pixel shows, as a colour.
///
/// DensePose's 24 charts become 14 parts: torso, head, and on either side hand, foot, thigh, shin, upper arm, forearm.
/// Fronts and backs share a part, as in the data that the method was published with (3DPeople), whose colours are not
/// public; these are the corners and edge centres of the RGB cube, so that no two parts are nearer than half its side.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bodyloom {

inline constexpr int kBodyParts = 15;  ///< with the background, part 0

/// Of DensePose's chart 0–24.
int BodyPartOf(int chart);
inline constexpr int kLimbs = 9, kHeadLimb = 2;
/// The same with left and right alike: 0 background, 1 torso, 2 head, 3 hands, 4 feet, 5 thighs, 6 shins, 7 upper arms,
/// 8 forearms.
int LimbOf(int chart);

/// RGB in [0, 1]; black for the background.
std::array<float, 3> BodyPartColour(int part);

/// Charts of n pixels → 3 × n planar RGB. Throws std::invalid_argument for a chart above 24.
std::vector<float> BodyPartMap(std::span<const uint8_t> charts);

// Which texels lie on the head, and which of them at its back.

struct HeadTexels {
  std::vector<uint8_t> head;  ///< U × U: 1 for texels of the head
  std::vector<uint8_t> back;  ///< U × U: 1 for those of them behind the middle of its depth
};

/// `texel_parts`: U × U, DensePose's part; `texel_places`: planar 3 × U × U, where texels lie in the rest pose (z to
/// the front). Throws std::invalid_argument for sizes that do not fit and parts above 24.
HeadTexels HeadTexelsOf(std::span<const uint8_t> texel_parts, std::span<const float> texel_places);

}  // namespace bodyloom
