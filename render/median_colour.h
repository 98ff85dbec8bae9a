// SPDX-License-Identifier: Apache-2.0
/// The middle of many colours.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace bodyloom {

/// Three channels, in whatever order and unit they are given.
using ChannelTriple = std::array<float, 3>;

/// The median of each channel on its own, of an even number of colours the mean of its two middle values. Up to half of
/// the colours may be anything without moving it beyond the others. Values are finite. Throws std::invalid_argument of
/// no colour.
ChannelTriple MedianColour(std::span<const ChannelTriple> colours);

/// The same; none of fewer than `fewest`, which are not worth asking. Throws as MedianColour() for fewest 0.
std::optional<ChannelTriple> MedianColourOfMany(std::span<const ChannelTriple> colours, size_t fewest);

}  // namespace bodyloom
