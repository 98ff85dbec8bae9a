// SPDX-License-Identifier: Apache-2.0
#include "render/image/person_layers.h"

#include <gtest/gtest.h>

namespace bodyloom::person_layers_test {
namespace {

TEST(PersonLayers, TheBoxIsAroundWhatIsCovered) {
  std::vector<uint8_t> coverage(100 * 50, 0);
  EXPECT_EQ(BoxAround(100, 50, coverage, 5).pixels(), 0U) << "nobody";
  for (int x = 90; x < 100; ++x) coverage[20 * 100 + x] = 1;
  const PersonLayers layers = BoxAround(100, 50, coverage, 5);
  EXPECT_EQ(layers.width, kLayersMultiple);
  EXPECT_EQ(layers.height, kLayersMultiple);
  EXPECT_EQ(layers.x, 90 - 27) << "as far on the left as on the right";
  EXPECT_EQ(layers.y, 20 - 31);
  EXPECT_EQ(BoxAround(100, 50, coverage, 28).width, 2 * kLayersMultiple);
  int visited = 0;
  ForEachPixel(layers, 100, 50, [&](int x, int y, size_t i) {
    ++visited;
    ASSERT_EQ(i, static_cast<size_t>(y - layers.y) * layers.width + (x - layers.x));
  });
  EXPECT_EQ(visited, 37 * 50) << "of the box what lies in the image";
}

}  // namespace
}  // namespace bodyloom::person_layers_test
