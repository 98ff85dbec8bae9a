// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/cloth_material.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace bodyloom::cloth_stuff_test {
namespace {

TEST(ClothStuff, HasANameForEach) {
  for (const ClothStuff stuff : {ClothStuff::kCotton, ClothStuff::kSilk, ClothStuff::kDenim}) {
    EXPECT_EQ(ClothStuffFromString(ToString(stuff)), stuff);
  }
  for (const std::string other : {"", "Silk", "wool", "silk "}) {
    EXPECT_THROW((void)ClothStuffFromString(other), std::invalid_argument) << other;
  }
}

TEST(ClothStuff, CottonIsWhatClothIsUntold) {
  const LooseGarmentOptions cut, sewn = SewnOf(ClothStuff::kCotton, cut);
  EXPECT_EQ(sewn.mass_kg_m2, cut.mass_kg_m2);
  EXPECT_EQ(sewn.bend_compliance, cut.bend_compliance);
  EXPECT_EQ(sewn.shear_compliance, cut.shear_compliance);
  EXPECT_EQ(sewn.spacing_m, cut.spacing_m);
  const ClothOptions options, moved = MovedAs(ClothStuff::kCotton, options);
  EXPECT_EQ(moved.friction, options.friction);
  EXPECT_EQ(moved.damping, options.damping);
}

TEST(ClothStuff, KeepsTheCutAndWhatIsFinerAlready) {
  LooseGarmentOptions cut;
  cut.waist_y_m = 0.1, cut.length_m = 0.7, cut.fullness = 0.4, cut.spacing_m = 0.01;
  for (const ClothStuff stuff : {ClothStuff::kSilk, ClothStuff::kDenim}) {
    const LooseGarmentOptions sewn = SewnOf(stuff, cut);
    EXPECT_EQ(sewn.waist_y_m, 0.1);
    EXPECT_EQ(sewn.length_m, 0.7);
    EXPECT_EQ(sewn.fullness, 0.4);
    EXPECT_EQ(sewn.spacing_m, 0.01);
    std::string why;
    EXPECT_TRUE(MovedAs(stuff, {}).IsValid(&why)) << why;
  }
  EXPECT_LT(SewnOf(ClothStuff::kSilk, {}).mass_kg_m2, SewnOf(ClothStuff::kDenim, {}).mass_kg_m2);
}

}  // namespace
}  // namespace bodyloom::cloth_stuff_test
