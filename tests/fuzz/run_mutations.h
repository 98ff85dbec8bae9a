// SPDX-License-Identifier: Apache-2.0
/// Runs a fuzz target on fixed mutations of its seeds: bit flips, overwritten numbers, truncations, repeats and
/// splices. The mutations are identical on every machine, so that failures are reproducible. ./dev test uses it in
/// place of libFuzzer.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "tests/data_tools/fuzz/fuzz_seeds.h"

namespace bodyloom::fuzz {

class Mutator {
 public:
  explicit Mutator(const std::vector<std::string>& seeds) : seeds_(seeds) {}

  std::string Next() {
    std::string bytes = seeds_[Below(seeds_.size())];
    for (size_t n = 1 + Below(3); n > 0; --n) Mutate(&bytes);
    return bytes;
  }

 private:
  size_t Below(size_t n) { return n == 0 ? 0 : random_() % n; }

  void Mutate(std::string* bytes) {
    if (bytes->empty()) return;
    const size_t at = Below(bytes->size());
    switch (Below(6)) {
      case 0:
        (*bytes)[at] = static_cast<char>((*bytes)[at] ^ (1 << Below(8)));
        break;
      case 1:
        (*bytes)[at] = static_cast<char>(random_());
        break;
      case 2: {  // a number at the edge of its range
        static constexpr uint64_t kEdges[] = {0,      1,          0x7F,       0xFF,         0x7FFF,
                                              0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF, ~uint64_t{0}, 1ULL << 32};
        uint64_t value = kEdges[Below(std::size(kEdges))];
        for (size_t i = at, n = size_t{1} << Below(4); n > 0 && i < bytes->size(); ++i, --n, value >>= 8) {
          (*bytes)[i] = static_cast<char>(value);
        }
        break;
      }
      case 3:
        bytes->resize(at);
        break;
      case 4:
        bytes->insert(at, bytes->substr(Below(bytes->size()), 1 + Below(64)));
        break;
      case 5: {
        const std::string& other = seeds_[Below(seeds_.size())];
        *bytes = bytes->substr(0, at) + other.substr(Below(other.size()));
        break;
      }
    }
  }

  const std::vector<std::string>& seeds_;
  std::mt19937 random_{20};
};

/// Every seed must be accepted; some mutations must be accepted and some rejected, as the test has no power otherwise.
template <typename Function>
void RunMutations(const std::string& name, const Function& accepts, int mutations) {
  const std::vector<std::string> seeds = Seeds().at(name);
  for (size_t i = 0; i < seeds.size(); ++i) EXPECT_TRUE(accepts(seeds[i])) << name << " seed " << i;
  Mutator mutator(seeds);
  int accepted = 0;
  for (int i = 0; i < mutations; ++i) {
    const std::string bytes = mutator.Next();
    try {
      accepted += accepts(bytes) ? 1 : 0;
    } catch (const std::exception& error) {
      FAIL() << name << " mutation " << i << " (" << bytes.size() << " bytes): " << error.what();
    }
  }
  EXPECT_GT(accepted, mutations / 100);
  EXPECT_LT(accepted, mutations - mutations / 20);
}

}  // namespace bodyloom::fuzz
