// SPDX-License-Identifier: Apache-2.0
/// Random numbers that depend on nothing but a seed and a name: the same on every machine, and independent between
/// frames, so that frames may be made in any order and on any number of threads. Arguments of one call are evaluated in
/// an order that is the compiler's choice: draw them into variables, or within braces, which go from left to right
/// (tests/layering/check_draws.py).
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "bodyloom/geometry/base/split_mix.h"

namespace bodyloom {

class HashRandom {
 public:
  /// A stream of its own for each seed and list of keys (what it is for, frame, joint, …).
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

  /// Mean 0, variance 1 (Box and Muller; the second value is not kept, so that every call costs two numbers).
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
