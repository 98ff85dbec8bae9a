// SPDX-License-Identifier: Apache-2.0
#include "pipelines/gaussian_avatar/avatar_scores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "data_tools/evaluation/ssim.h"

namespace bodyloom::avatar_scores_test {
namespace {

TEST(ImageLossAndScores, HaveOneSsim) {
  constexpr int kWidth = 45, kHeight = 33, kArea = kWidth * kHeight;
  std::mt19937 generator(4);
  ImageTruth truth;
  truth.width = kWidth, truth.height = kHeight, truth.person_pixels = kArea;
  truth.planes.Resize(4, kArea);
  FloatColumns image(4, kArea), by_planes;
  PlanarImage a = {kWidth, kHeight, 3, std::vector<double>(3 * kArea)}, b = a;
  double l1 = 0;
  for (int i = 0; i < kArea; ++i) {
    truth.planes(i, 3) = image(i, 3) = 1;
    for (int c = 0; c < 3; ++c) {
      const float value = 0.5F + 0.4F * std::sin(0.3F * static_cast<float>(i % kWidth + c));
      a.values[c * kArea + i] = truth.planes(i, c) = value;
      b.values[c * kArea + i] = image(i, c) = value + static_cast<float>(generator() / 4294967296.0 - 0.5) * 0.2F;
      l1 += std::abs(a.values[c * kArea + i] - b.values[c * kArea + i]);
    }
  }
  const double loss = ImageLoss().Compute(image, truth, {0.3F, 0.6F, 0.9F}, 1, &by_planes);
  const double ssim = Ssim(a, b, SsimPreset::k3dgs, 1);
  EXPECT_GT(1 - ssim, 0.05);
  EXPECT_NEAR(loss, (0.8 * l1 / (3 * kArea) + 0.2 * (1 - ssim)) / 1.3, 1e-6);
}

/// A window of 20 × 10 whose left half shows a person of one grey.
TrainingView HalfPerson(uint8_t grey) {
  TrainingView view;
  view.window = {3, 4, 23, 14};
  view.person_pixels = 100;
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 20; ++x) {
      const uint8_t inside = x < 10 ? 1 : 0;
      view.pixels.insert(view.pixels.end(), {grey, grey, grey, inside});
    }
  }
  return view;
}

TEST(AvatarScorer, NothingDrawnIsThePersonsOwnBrightness) {
  SplatImage image;
  image.Draw(ScreenGaussians(), {3, 4, 23, 14});
  AvatarScorer scorer;
  scorer.Add(HalfPerson(51), image);  // a fifth of white
  scorer.Add(HalfPerson(51), image);
  const AvatarScores means = scorer.Means();
  EXPECT_EQ(means.frames, 2);
  EXPECT_NEAR(means.psnr_person_db, 20 * std::log10(5.0), 1e-9);
  EXPECT_NEAR(means.psnr_box_db, 20 * std::log10(5.0) + 10 * std::log10(2.0), 1e-9);
  EXPECT_NEAR(means.l1, 0.1, 1e-12);
  EXPECT_EQ(means.outline_iou, 0);
  EXPECT_LT(means.ssim, 0.9);
  SplatImage other;
  other.Draw(ScreenGaussians(), {0, 0, 20, 11});
  EXPECT_THROW(scorer.Add(HalfPerson(51), other), std::invalid_argument);
}

TEST(AvatarScorer, TheGarmentIsComparedWithTheLabelItCovers) {
  TrainingView view = HalfPerson(51);
  std::vector<float> garment(200, 0.4F);
  for (int y = 0; y < 10; ++y) {
    // Of the person's ten columns the first two are a top, the other eight a skirt, of which columns 4 to 11 are found.
    for (int x = 2; x < 10; ++x) view.pixels[4 * (20 * y + x) + 3] = 2;
    for (int x = 4; x < 12; ++x) garment[20 * y + x] = 0.6F;
  }
  SplatImage image;
  image.Draw(ScreenGaussians(), view.window);
  AvatarScorer scorer;
  scorer.Add(view, image, garment);
  ASSERT_TRUE(scorer.Means().garment_iou.has_value());
  EXPECT_NEAR(*scorer.Means().garment_iou, 6.0 / 10, 1e-12);
  EXPECT_THROW(scorer.Add(view, image, std::span(garment).first(9)), std::invalid_argument);
  AvatarScorer with_mask;
  with_mask.Add(HalfPerson(51), image, garment);
  EXPECT_FALSE(with_mask.Means().garment_iou.has_value()) << "a mask has no labels";
}

TEST(AvatarScorer, WindowsShowThePersonOverBlack) {
  const Image window = TrueWindow(HalfPerson(77));
  EXPECT_EQ(window.at(9, 0), (Colour{77, 77, 77}));
  EXPECT_EQ(window.at(10, 0), (Colour{0, 0, 0}));
}

}  // namespace
}  // namespace bodyloom::avatar_scores_test
