// SPDX-License-Identifier: Apache-2.0
/// Front to back: a stable radix sort by depth.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace bodyloom {

/// Keeps its memory between calls.
class DepthOrder {
 public:
  /// `rows`, indices into depth, ordered by depth[row]: smaller first, equal ones (0 and −0 are not) as they were.
  /// O(n): one pass for every 11 bits in which the depths differ, three at most. The depths must not be NaN. The
  /// answer lives until the next call.
  std::span<const int32_t> Sort(std::span<const float> depth, std::span<const int32_t> rows);

 private:
  struct Item {
    uint32_t key;
    int32_t row;
  };
  std::vector<Item> items_, other_;
  std::vector<int32_t> sorted_;
};

}  // namespace bodyloom
