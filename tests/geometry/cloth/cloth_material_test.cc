// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/cloth_material.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace bodyloom::cloth_material_test {
namespace {

TEST(ClothMaterial, HasANameForEach) {
  for (const ClothMaterial material : {ClothMaterial::kCotton, ClothMaterial::kSilk, ClothMaterial::kDenim}) {
    EXPECT_EQ(ClothMaterialFromString(ToString(material)), material);
  }
  for (const std::string other : {"", "Silk", "wool", "silk "}) {
    EXPECT_THROW((void)ClothMaterialFromString(other), std::invalid_argument) << other;
  }
}

TEST(ClothMaterial, CottonIsWhatClothIsUntold) {
  const LooseGarmentOptions cut, sewn = GarmentOptionsFor(ClothMaterial::kCotton, cut);
  EXPECT_EQ(sewn.mass_kg_m2, cut.mass_kg_m2);
  EXPECT_EQ(sewn.bend_compliance, cut.bend_compliance);
  EXPECT_EQ(sewn.shear_compliance, cut.shear_compliance);
  EXPECT_EQ(sewn.spacing_m, cut.spacing_m);
  const ClothOptions options, moved = ClothOptionsFor(ClothMaterial::kCotton, options);
  EXPECT_EQ(moved.friction, options.friction);
  EXPECT_EQ(moved.damping, options.damping);
}

TEST(ClothMaterial, KeepsTheCutAndWhatIsFinerAlready) {
  LooseGarmentOptions cut;
  cut.waist_y_m = 0.1, cut.length_m = 0.7, cut.fullness = 0.4, cut.spacing_m = 0.01;
  for (const ClothMaterial material : {ClothMaterial::kSilk, ClothMaterial::kDenim}) {
    const LooseGarmentOptions sewn = GarmentOptionsFor(material, cut);
    EXPECT_EQ(sewn.waist_y_m, 0.1);
    EXPECT_EQ(sewn.length_m, 0.7);
    EXPECT_EQ(sewn.fullness, 0.4);
    EXPECT_EQ(sewn.spacing_m, 0.01);
    std::string why;
    EXPECT_TRUE(ClothOptionsFor(material, {}).IsValid(&why)) << why;
  }
  EXPECT_LT(GarmentOptionsFor(ClothMaterial::kSilk, {}).mass_kg_m2,
            GarmentOptionsFor(ClothMaterial::kDenim, {}).mass_kg_m2);
}

}  // namespace
}  // namespace bodyloom::cloth_material_test
