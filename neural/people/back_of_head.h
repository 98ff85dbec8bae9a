// SPDX-License-Identifier: Apache-2.0
/// Which texels lie on the head, and which of them at its back.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace bodyloom {

struct HeadTexels {
  std::vector<uint8_t> head;  ///< U × U: 1 for texels of the head
  std::vector<uint8_t> back;  ///< U × U: 1 for those of them behind the middle of its depth
};

/// `texel_parts`: U × U, DensePose's part; `texel_places`: planar 3 × U × U, where texels lie in the rest pose (z to
/// the front). Throws std::invalid_argument for sizes that do not fit and parts above 24.
HeadTexels HeadTexelsOf(std::span<const uint8_t> texel_parts, std::span<const float> texel_places);

}  // namespace bodyloom
