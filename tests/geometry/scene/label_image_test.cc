// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/label_image.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "geometry/scene/observations.h"

namespace bodyloom::label_image_test {
namespace {

void ExpectEqual(const LabelImage& a, const LabelImage& b) {
  EXPECT_EQ(a.x_begin, b.x_begin);
  EXPECT_EQ(a.y_begin, b.y_begin);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.labels, b.labels);
}

TEST(LabelImage, LiesOverAnImageOfAnySize) {
  const LabelImage image{-1, 1, 3, 2, {1, 2, 3, 4, 5, 6}};
  EXPECT_EQ(image.Over(3, 4), (std::vector<uint8_t>{0, 0, 0, 2, 3, 0, 5, 6, 0, 0, 0, 0}));
  EXPECT_EQ(image.Over(1, 2), (std::vector<uint8_t>{0, 2}));
  EXPECT_TRUE(image.Over(0, 0).empty());
}

TEST(PackedLabels, GivesBackWhatItWasGiven) {
  std::mt19937 random(3);
  for (const int maximum : {1, 2, 40}) {  // long runs, short ones, hardly any two pixels alike
    LabelImage image{-3, 7, 31, 17, {}};
    uint8_t label = 0;
    for (int i = 0; i < 31 * 17; ++i) {
      if (random() % 40 < unsigned(maximum)) label = uint8_t(random() % (maximum == 1 ? 2 : 256));
      image.labels.push_back(label);
    }
    const PackedLabels packed = image;
    EXPECT_FALSE(packed.empty());
    ExpectEqual(packed.Unpacked(), image);
    for (int y = 5; y < 26; ++y) {
      for (int x = -6; x < 30; ++x) ASSERT_EQ(packed.At(x, y), image.At(x, y)) << x << ", " << y;
    }
  }
}

TEST(PackedLabels, NothingAndWhatCannotBeAreKept) {
  EXPECT_TRUE(PackedLabels().empty());
  EXPECT_TRUE(PackedLabels(LabelImage{4, 5, 0, 9, {}}).empty());
  EXPECT_EQ(PackedLabels().At(0, 0), 0);
  // Of labels that are not as many as pixels those that use them complain: they see them as they are.
  for (const size_t count : {size_t{5}, size_t{7}}) {
    const LabelImage wrong{0, 0, 3, 2, std::vector<uint8_t>(count, 8)};
    ExpectEqual(PackedLabels(wrong).Unpacked(), wrong);
  }
  EXPECT_EQ(PackedLabels(LabelImage{0, 0, 3, 2, std::vector<uint8_t>(5, 8)}).At(2, 1), 0);
}

TEST(PartLabelSequence, PartsOfAFrameAreThoseOfItsPixels) {
  PartLabelSequence labels;
  labels.frames = {LabelImage{1, 1, 3, 1, {2, 255, 0}}};
  labels.Merge(2, 9);
  EXPECT_EQ(labels.PartsOf(0).labels, (std::vector<uint8_t>{9, 255, 0}));
  EXPECT_EQ(labels.PartAt(0, 1, 1), 9);
  labels.AsMask();
  EXPECT_EQ(labels.PartsOf(0).labels, (std::vector<uint8_t>{1, 255, 0}));
}

}  // namespace
}  // namespace bodyloom::label_image_test
