// SPDX-License-Identifier: Apache-2.0
/// Colours of overlays, contact sheets and plots.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "render/image/image.h"

namespace bodyloom {

inline constexpr Colour kBodyColour{122, 166, 218};      ///< the estimated body
inline constexpr Colour kReferenceColour{226, 150, 92};  ///< the true body, if known
inline constexpr Colour kLeftColour{255, 145, 60};       ///< the person's left side
inline constexpr Colour kRightColour{40, 170, 235};      ///< the person's right side
inline constexpr Colour kMiddleColour{250, 220, 110};
inline constexpr Colour kDetectedColour{80, 220, 120};
inline constexpr Colour kInkColour{26, 32, 44};
inline constexpr Colour kPaperColour{248, 249, 251};

/// Colour of one of several people: the estimated body's for 0, then five others that differ in grey too, repeated
/// cyclically.
Colour PersonColour(int number);

/// Colour of a DensePose-style chart 1..24 (grey for 0): warm on the person's left, cool on its right, the back of a
/// limb darker than its front.
Colour PartColour(int part);

/// Colour of a chart in clothes: shirt, trousers, shoes, and skin elsewhere. For synthetic videos.
Colour ClothesColour(int part);

/// Three channels, in any order and unit.
using ChannelTriple = std::array<float, 3>;

/// Median of each channel; for an even number of colours the mean of the two middle values. Robust to up to half of
/// outliers. Values must be finite. Throws std::invalid_argument without colours.
ChannelTriple MedianColour(std::span<const ChannelTriple> colours);

/// MedianColour(), or empty for fewer than `fewest` colours. Throws as MedianColour() for fewest 0.
std::optional<ChannelTriple> MedianColourOfMany(std::span<const ChannelTriple> colours, size_t fewest);

}  // namespace bodyloom
