// SPDX-License-Identifier: Apache-2.0
/// Random choices as functions of numbers, so that a training run can go on from any step.
#pragma once

#include <cstdint>

namespace bodyloom {

/// SplitMix64 (Steele, Lea, Flood 2014).
inline uint64_t Mix(uint64_t x) {
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

/// In [0, 1).
inline double UniformOf(uint64_t hash) { return static_cast<double>(hash >> 11) * 0x1p-53; }

}  // namespace bodyloom
