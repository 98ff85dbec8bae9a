// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/splat/depth_order.h"

#include <algorithm>
#include <array>
#include <bit>

namespace bodyloom {
namespace {

constexpr int kDigitBits = 11;
constexpr uint32_t kDigits = 1U << kDigitBits;

/// Rises with the float.
uint32_t RisingKey(float depth) {
  const auto bits = std::bit_cast<uint32_t>(depth);
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

}  // namespace

std::span<const int32_t> DepthOrder::Sort(std::span<const float> depth, std::span<const int32_t> rows) {
  const size_t count = rows.size();
  items_.resize(count), other_.resize(count), sorted_.resize(count);
  uint32_t least = UINT32_MAX, most = 0;
  for (size_t i = 0; i < count; ++i) {
    const uint32_t key = RisingKey(depth[rows[i]]);
    items_[i] = {key, rows[i]};
    least = std::min(least, key), most = std::max(most, key);
  }
  const uint32_t range = count == 0 ? 0 : most - least;
  for (int shift = 0; shift < 32 && (range >> shift) != 0; shift += kDigitBits) {
    std::array<uint32_t, kDigits> at{};
    for (const Item& item : items_) ++at[((item.key - least) >> shift) % kDigits];
    uint32_t sum = 0;
    for (uint32_t& entry : at) {
      const uint32_t here = entry;
      entry = sum;
      sum += here;
    }
    for (const Item& item : items_) other_[at[((item.key - least) >> shift) % kDigits]++] = item;
    items_.swap(other_);
  }
  for (size_t i = 0; i < count; ++i) sorted_[i] = items_[i].row;
  return sorted_;
}

}  // namespace bodyloom
