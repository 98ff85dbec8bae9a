// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/clothes_parser.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "render/view/overlay.h"

namespace bodyloom::label_colours_test {
namespace {

using enum PersonLabel;

constexpr int kWidth = 20, kHeight = 60;
constexpr Colour kSkinColour{210, 160, 140}, kShirt{40, 90, 60}, kTrousers{30, 30, 60};

/// From above: 10 rows of face, 20 of shirt, 10 of an arm, 20 of trousers.
struct Scene {
  Scene() : image(kWidth, kHeight) {
    for (int y = 0; y < kHeight; ++y) {
      const PersonLabel label = y < 10 ? kFace : (y < 30 ? kTop : (y < 40 ? kSkin : kBottom));
      const Colour colour = y < 10 || (y >= 30 && y < 40) ? kSkinColour : (y < 30 ? kShirt : kTrousers);
      for (int x = 0; x < kWidth; ++x) {
        labels.push_back(static_cast<uint8_t>(label));
        uint8_t* p = image.pixel(x, y);
        p[0] = colour.blue, p[1] = colour.green, p[2] = colour.red;
      }
    }
  }
  uint8_t& At(int x, int y) { return labels[static_cast<size_t>(y) * kWidth + x]; }
  Image image;
  std::vector<uint8_t> labels;
};

TEST(RelabelByColour, WhatIsRightStays) {
  Scene scene;
  const std::vector<uint8_t> before = scene.labels;
  RelabelByColour(scene.image, scene.labels);
  EXPECT_EQ(scene.labels, before);
}

TEST(RelabelByColour, SkinAndClothesAreExchangedWhereColoursSaySo) {
  Scene scene;
  const std::vector<uint8_t> truth = scene.labels;
  for (int x = 0; x < kWidth; ++x) {
    scene.At(x, 30) = static_cast<uint8_t>(kTop);     // a sleeve that the arm does not have
    scene.At(x, 39) = static_cast<uint8_t>(kBottom);  // a hand on the trousers
    scene.At(x, 29) = static_cast<uint8_t>(kSkin);    // a hem called skin
    scene.At(x, 40) = static_cast<uint8_t>(kSkin);
  }
  ASSERT_NE(scene.labels, truth);
  RelabelByColour(scene.image, scene.labels);
  EXPECT_EQ(scene.labels, truth);
}

TEST(RelabelByColour, ABareChestThatIsCalledATopStaysOne) {
  Scene scene;
  for (int y = 10; y < 30; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      uint8_t* p = scene.image.pixel(x, y);
      p[0] = kSkinColour.blue, p[1] = kSkinColour.green, p[2] = kSkinColour.red;
    }
  }
  const std::vector<uint8_t> before = scene.labels;
  RelabelByColour(scene.image, scene.labels);
  EXPECT_EQ(scene.labels, before);
}

TEST(RelabelByColour, HairShoesAndFacesAreLeftAlone) {
  for (const PersonLabel label : {kHair, kShoes, kFace}) {
    Scene scene;
    for (int x = 0; x < kWidth; ++x) scene.At(x, 35) = static_cast<uint8_t>(label);
    const std::vector<uint8_t> before = scene.labels;
    RelabelByColour(scene.image, scene.labels);
    EXPECT_EQ(scene.labels, before);
  }
}

TEST(RelabelByColour, WithoutAFaceNothingIsKnown) {
  Scene scene;
  for (size_t i = 0; i < scene.labels.size(); ++i) {
    if (scene.labels[i] == static_cast<uint8_t>(kFace)) scene.labels[i] = static_cast<uint8_t>(kHair);
  }
  for (int x = 0; x < kWidth; ++x) scene.At(x, 30) = static_cast<uint8_t>(kTop);
  const std::vector<uint8_t> before = scene.labels;
  RelabelByColour(scene.image, scene.labels);
  EXPECT_EQ(scene.labels, before);
  std::vector<uint8_t> nobody(scene.labels.size(), 0);
  RelabelByColour(scene.image, nobody);
  EXPECT_EQ(nobody, std::vector<uint8_t>(scene.labels.size(), 0));
  scene.labels.pop_back();
  EXPECT_THROW(RelabelByColour(scene.image, scene.labels), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::label_colours_test
