// SPDX-License-Identifier: Apache-2.0
#include "render/splat/splat_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace bodyloom::depth_order_test {
namespace {

std::vector<int32_t> Expected(const std::vector<float>& depth, std::vector<int32_t> rows) {
  std::stable_sort(rows.begin(), rows.end(), [&](int a, int b) { return depth[a] < depth[b]; });
  return rows;
}

void ExpectSorted(const std::vector<float>& depth, const std::vector<int32_t>& rows) {
  DepthOrder order;
  const auto sorted = order.Sort(depth, rows);
  EXPECT_EQ(std::vector<int32_t>(sorted.begin(), sorted.end()), Expected(depth, rows));
}

std::vector<int32_t> AllRows(size_t count) {
  std::vector<int32_t> rows(count);
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

TEST(DepthOrder, IsThatOfAStableSort) {
  std::mt19937 generator(3);
  for (const float scale : {1e-6F, 1.0F, 1e30F}) {
    for (const int steps : {3, 50, 1 << 20}) {  // few steps: many equal depths
      std::vector<float> depth(5000);
      const int below_zero = steps / 3;
      for (float& d : depth) d = scale * static_cast<float>(static_cast<int>(generator() % steps) - below_zero);
      for (float& d : depth) d = d == 0 ? 0.0F : d;
      ExpectSorted(depth, AllRows(depth.size()));
    }
  }
}

TEST(DepthOrder, OfSomeRowsInAnyOrder) {
  std::vector<float> depth = {5, 1, 4, 1, 3, 1};
  ExpectSorted(depth, {5, 0, 3, 4, 1});
}

TEST(DepthOrder, NeighbouringFloatsAndInfinities) {
  std::vector<float> depth = {INFINITY, 1, std::nextafter(1.0F, 2.0F), std::nextafter(1.0F, 0.0F), -INFINITY, 1};
  ExpectSorted(depth, AllRows(depth.size()));
}

TEST(DepthOrder, OfNothingAndOfOne) {
  ExpectSorted({}, {});
  ExpectSorted({2}, {0});
}

}  // namespace
}  // namespace bodyloom::depth_order_test
