// SPDX-License-Identifier: Apache-2.0
/// Random choices as functions of numbers: SplitMix64 (Steele, Lea, Flood 2014), a counter through a mixing function.
#pragma once

#include <cstdint>

namespace bodyloom {

/// What the counter goes up by.
inline constexpr uint64_t kSplitMixStep = 0x9E3779B97F4A7C15U;

/// The mixing function.
inline uint64_t MixBits(uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

/// The generator's first number when its counter stands at x.
inline uint64_t Mix(uint64_t x) { return MixBits(x + kSplitMixStep); }

/// In [0, 1).
inline double UniformOf(uint64_t hash) { return static_cast<double>(hash >> 11) * 0x1p-53; }

}  // namespace bodyloom
