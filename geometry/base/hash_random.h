// SPDX-License-Identifier: Apache-2.0
/// Random numbers that depend only on a seed and a list of keys: the same on every machine, and independent between
/// frames, so that frames may be made in any order and on any number of threads. The compiler chooses the order in
/// which arguments of one call are evaluated, so draw into variables first, or within braces, which are evaluated from
/// left to right (tests/layering/check_draws.py).
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace bodyloom {

// SplitMix64 (Steele, Lea, Flood 2014): a counter passed through a mixing function.

/// Increment of the counter.
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

class HashRandom {
 public:
  /// Starts the independent stream of a seed and a list of keys (purpose, frame, joint, …).
  HashRandom(uint64_t seed, std::initializer_list<uint64_t> keys) : state_(MixBits(seed ^ 0x5bd1e9955bd1e995ULL)) {
    for (const uint64_t key : keys) state_ = MixBits(state_ ^ Mix(key));
  }

  uint64_t Next() {
    state_ += kSplitMixStep;
    return MixBits(state_);
  }

  /// In [0, 1).
  double Uniform() { return UniformOf(Next()); }
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }

  /// 0 … n−1. The bias of the remainder is below n/2^64.
  uint64_t Below(uint64_t n) { return Next() % n; }

  /// Mean 0, variance 1 (Box and Muller; the second value is not kept, so every call uses two numbers).
  double Normal() {
    const double u = 1 - Uniform(), v = Uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
  }

  /// Mean 1.
  double Exponential() { return -std::log(1 - Uniform()); }

 private:
  uint64_t state_;
};

}  // namespace bodyloom
