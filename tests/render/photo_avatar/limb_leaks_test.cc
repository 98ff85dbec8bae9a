// SPDX-License-Identifier: Apache-2.0
#include "render/photo_avatar/photo_person_builder.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "render/view/overlay.h"

namespace bodyloom::limb_leaks_test {
namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr int kTorso = 2, kForearm = 19, kHead = 23;
constexpr Colour kSkinColour{200, 160, 140}, kShirt{30, 40, 160};

/// A trunk from column 0 to 29, a face in the first rows; the fitted forearm is columns 30 to 34.
struct Scene {
  Scene() : image(kWidth, kHeight, kShirt) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool arm = x >= 30 && x < 35, face = y < 6;
        parts.push_back(face ? kHead : (arm ? kForearm : (x < 30 ? kTorso : 0)));
        labels.push_back(
            static_cast<uint8_t>(face ? PersonLabel::kFace : (arm ? PersonLabel::kSkin : PersonLabel::kTop)));
        if (face || arm) Paint(x, y, kSkinColour);
      }
    }
    mask.assign(parts.size(), 1);
  }
  void Paint(int x, int y, const Colour& colour) {
    uint8_t* p = image.pixel(x, y);
    p[0] = colour.blue, p[1] = colour.green, p[2] = colour.red;
  }
  [[nodiscard]] std::vector<uint8_t> Kept(int reach_px) const {
    return WithoutLimbLeaks(image, mask, labels, parts, reach_px);
  }
  static size_t At(int x, int y) { return static_cast<size_t>(y) * kWidth + x; }
  Image image;
  std::vector<uint8_t> mask, labels, parts;
};

TEST(LimbLeaks, NothingLeaksWhereTheShirtIsSeen) {
  const Scene scene;
  EXPECT_EQ(scene.Kept(8), scene.mask);
}

TEST(LimbLeaks, SkinBesideTheFittedArmIsTheArms) {
  Scene scene;
  scene.labels[Scene::At(27, 15)] = static_cast<uint8_t>(PersonLabel::kSkin);  // by its label
  scene.Paint(25, 20, {190, 150, 135});  // by its colour, though it is called a shirt
  scene.labels[Scene::At(10, 15)] = static_cast<uint8_t>(PersonLabel::kSkin);  // far away: a hole, or bare
  const std::vector<uint8_t> kept = scene.Kept(8);
  EXPECT_EQ(kept[Scene::At(27, 15)], 0);
  EXPECT_EQ(kept[Scene::At(25, 20)], 0);
  EXPECT_EQ(kept[Scene::At(10, 15)], 1);
  EXPECT_EQ(kept[Scene::At(32, 15)], 1) << "the arm itself";
  EXPECT_EQ(kept[Scene::At(29, 3)], 1) << "the face";
  size_t gone = 0;
  for (const uint8_t k : kept) gone += k == 0 ? 1 : 0;
  EXPECT_EQ(gone, 2U);
  EXPECT_EQ(scene.Kept(4)[Scene::At(25, 20)], 1) << "out of reach";
}

TEST(LimbLeaks, ABareChestIsKeptByItsColour) {
  Scene scene;
  for (int y = 6; y < kHeight; ++y) {
    for (int x = 0; x < 30; ++x) scene.Paint(x, y, {198, 158, 142});
  }
  EXPECT_EQ(scene.Kept(8), scene.mask) << "trunk and arm are of one colour";
}

TEST(LimbLeaks, WithoutAFaceLabelsDecide) {
  Scene scene;
  for (size_t i = 0; i < scene.labels.size(); ++i) {
    if (scene.parts[i] == kHead) scene.labels[i] = static_cast<uint8_t>(PersonLabel::kHair);
  }
  scene.Paint(25, 20, kSkinColour);
  EXPECT_EQ(scene.Kept(8), scene.mask);
  scene.labels[Scene::At(25, 20)] = static_cast<uint8_t>(PersonLabel::kSkin);
  EXPECT_EQ(scene.Kept(8)[Scene::At(25, 20)], 0);
}

TEST(LimbLeaks, RefusesOtherSizes) {
  Scene scene;
  scene.parts.pop_back();
  EXPECT_THROW(scene.Kept(8), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::limb_leaks_test
