// SPDX-License-Identifier: Apache-2.0
/// The colours of the project's pictures.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "render/image/image.h"

namespace bodyloom {

inline constexpr Colour kBodyColour{122, 166, 218};      ///< the estimated body
inline constexpr Colour kReferenceColour{226, 150, 92};  ///< the true body, where it is known
inline constexpr Colour kLeftColour{255, 145, 60};       ///< the person's left side
inline constexpr Colour kRightColour{40, 170, 235};      ///< the person's right side
inline constexpr Colour kMiddleColour{250, 220, 110};
inline constexpr Colour kDetectedColour{80, 220, 120};
inline constexpr Colour kInkColour{26, 32, 44};
inline constexpr Colour kPaperColour{248, 249, 251};

/// Colour of one of several people: the estimated body's for 0, then five others that are told apart in grey too, over
/// and over.
Colour PersonColour(int number);

/// Colour of a DensePose-style chart 1..24 (grey for 0): warm on the person's left, cool on its right, the back of a
/// limb darker than its front.
Colour PartColour(int part);

/// The same charts as clothes: shirt, trousers, shoes, and skin elsewhere. For made-up videos of a person.
Colour ClothesColour(int part);

// The middle of many colours.

/// Three channels, in whatever order and unit they are given.
using ChannelTriple = std::array<float, 3>;

/// The median of each channel on its own, of an even number of colours the mean of its two middle values. Up to half of
/// the colours may be anything without moving it beyond the others. Values are finite. Throws std::invalid_argument of
/// no colour.
ChannelTriple MedianColour(std::span<const ChannelTriple> colours);

/// The same; none of fewer than `fewest`, which are not worth asking. Throws as MedianColour() for fewest 0.
std::optional<ChannelTriple> MedianColourOfMany(std::span<const ChannelTriple> colours, size_t fewest);

}  // namespace bodyloom
