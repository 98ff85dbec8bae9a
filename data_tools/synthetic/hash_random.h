// SPDX-License-Identifier: Apache-2.0
/// Random numbers that depend on nothing but a seed and a name: the same on every machine, and independent between
/// frames, so that frames may be made in any order and on any number of threads.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace bodyloom {

/// SplitMix64 (Steele, Lea, Flood 2014): a counter through a mixing function.
class HashRandom {
 public:
  /// A stream of its own for each seed and list of keys (what it is for, frame, joint, …).
  HashRandom(uint64_t seed, std::initializer_list<uint64_t> keys) : state_(Mix(seed ^ 0x5bd1e9955bd1e995ULL)) {
    for (const uint64_t key : keys) state_ = Mix(state_ ^ Mix(key + 0x9e3779b97f4a7c15ULL));
  }

  uint64_t Next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    return Mix(state_);
  }

  /// In [0, 1).
  double Uniform() { return static_cast<double>(Next() >> 11) * 0x1.0p-53; }
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }

  /// 0 … n−1. The bias of the remainder is below n/2^64.
  uint64_t Below(uint64_t n) { return Next() % n; }

  /// Mean 0, variance 1 (Box and Muller; the second value is not kept, so that every call costs two numbers).
  double Normal() {
    const double u = 1 - Uniform(), v = Uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
  }

  /// Mean 1.
  double Exponential() { return -std::log(1 - Uniform()); }

 private:
  static uint64_t Mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  uint64_t state_;
};

}  // namespace bodyloom
