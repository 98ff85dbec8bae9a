// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/background_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/tracking/detection/masked_clip.h"

namespace bodyloom::background_cut_test {
namespace {

constexpr int kFrames = 20;

/// A clip, what is behind its person, and how the person is coloured.
struct Known {
  MaskedClip clip;
  StillBackground background;
  ColourDensity person;
  explicit Known(double gain = 1) : clip(kFrames, 0, gain) {
    background.colours = clip.wall;
    background.sigma.assign(clip.masks[0].size(), 3);
    for (int t = 0; t < kFrames / 2; ++t) AddClearInside(clip.images[t], clip.CoarseMask(t), &person);
  }
  [[nodiscard]] std::vector<uint8_t> CutAt(int t, std::span<const uint8_t> others = {}) const {
    return Whole(*CutFromBackground(clip.images[t], clip.CoarseMask(t), others, background, person));
  }
  static std::vector<uint8_t> Whole(const LabelImage& mask) {
    std::vector<uint8_t> whole;
    for (int y = 0; y < MaskedClip::kHeight; ++y) {
      for (int x = 0; x < MaskedClip::kWidth; ++x) whole.push_back(mask.At(x, y));
    }
    return whole;
  }
};

TEST(BackgroundCut, FindsThePersonFromACoarseMask) {
  const Known known;
  for (const int t : {0, 7, 13, 19}) {
    const double coarse = OverlapOf(known.clip.CoarseMask(t), known.clip.masks[t]);
    EXPECT_LT(coarse, 0.8);
    EXPECT_GT(OverlapOf(known.CutAt(t), known.clip.masks[t]), 0.99) << t;
  }
}

TEST(BackgroundCut, FollowsTheLight) {
  for (const double gain : {0.85, 1.15}) {
    const Known known(gain);
    EXPECT_GT(OverlapOf(known.CutAt(18), known.clip.masks[18]), 0.98) << gain;
  }
}

TEST(BackgroundCut, AShadowIsNotThePerson) {
  Known known;
  std::vector<uint8_t> shadowed = known.clip.masks[10];
  for (int y = 98; y < 114; ++y) {
    for (int x = 30; x < 130; ++x) {
      uint8_t* bgr = known.clip.images[10].pixel(x, y);
      const bool is_wall = known.clip.masks[10][size_t(y) * MaskedClip::kWidth + x] == 0;
      for (int c = 0; is_wall && c < 3; ++c) bgr[c] = static_cast<uint8_t>(0.75 * bgr[c]);
    }
  }
  EXPECT_GT(OverlapOf(known.CutAt(10), known.clip.masks[10]), 0.97);
}

TEST(BackgroundCut, WhereNothingIsKnownBehindItGoesByTheColoursAround) {
  Known known;
  for (int y = 0; y < 50; ++y)
    std::fill_n(known.background.sigma.begin() + y * MaskedClip::kWidth, MaskedClip::kWidth, 0.0F);
  const std::vector<uint8_t> cut = known.CutAt(9), truth = known.clip.masks[9];
  const auto unknown = size_t(50) * MaskedClip::kWidth;
  EXPECT_GT(OverlapOf(std::span(cut).first(unknown), std::span(truth).first(unknown)), 0.9);
  EXPECT_GT(OverlapOf(std::span(cut).subspan(unknown), std::span(truth).subspan(unknown)), 0.98);
}

TEST(BackgroundCut, ColoursThatThePersonSharesWithTheWallDoNotTearItApart) {
  Known known;
  // A board as dark as the trousers, where the person stands.
  for (int y = 75; y < 95; ++y) {
    for (int x = 40; x < 120; ++x) {
      uint8_t* wall = known.background.colours.pixel(x, y);
      uint8_t* seen = known.clip.images[10].pixel(x, y);
      wall[0] = 30, wall[1] = 22, wall[2] = 20;
      if (known.clip.masks[10][size_t(y) * MaskedClip::kWidth + x] == 0) std::copy_n(wall, 3, seen);
    }
  }
  const std::vector<uint8_t> cut = known.CutAt(10);
  for (int y = 20; y < 105; ++y) {
    int inside = 0;
    for (int x = 0; x < MaskedClip::kWidth; ++x) inside += cut[size_t(y) * MaskedClip::kWidth + x];
    EXPECT_GE(inside, 19) << y;
    EXPECT_LE(inside, 33) << y;
  }
}

TEST(BackgroundCut, LeavesToOthersWhatIsTheirs) {
  const Known known;
  std::vector<uint8_t> others(known.clip.masks[10].size(), 0);
  const std::vector<uint8_t> coarse = known.clip.CoarseMask(10);
  // The lower part is somebody else's.
  std::vector<uint8_t> upper = coarse;
  for (size_t i = size_t(80) * MaskedClip::kWidth; i < others.size(); ++i)
    others[i] = known.clip.masks[10][i], upper[i] = 0;
  const Image& image = known.clip.images[10];
  const std::vector<uint8_t> mask =
      Known::Whole(*CutFromBackground(image, upper, others, known.background, known.person));
  EXPECT_EQ(std::count(mask.begin() + size_t(82) * MaskedClip::kWidth, mask.end(), 1), 0);
  EXPECT_GT(std::count(mask.begin(), mask.end(), 1), 1400);
  EXPECT_FALSE(CutFromBackground(image, upper, {}, known.background, known.person).has_value())
      << "somebody whom nobody told of stands there";
}

TEST(BackgroundCut, IsNoneWhereTheBackgroundIsAnother) {
  const Known known;
  // As if the camera had turned by 5 px: the wall's waves are elsewhere.
  Image moved(MaskedClip::kWidth, MaskedClip::kHeight);
  Paste(known.clip.images[10], 5, 0, &moved);
  std::vector<uint8_t> coarse(known.clip.masks[10].size(), 0);
  for (size_t i = 5; i < coarse.size(); ++i) coarse[i] = known.clip.masks[10][i - 5];
  EXPECT_FALSE(CutFromBackground(moved, coarse, {}, known.background, known.person).has_value());
  EXPECT_TRUE(CutFromBackground(known.clip.images[10], known.clip.masks[10], {}, known.background, known.person));
}

TEST(BackgroundCut, StraysAreLeftOutAndNobodyIsNobody) {
  const Known known;
  std::vector<uint8_t> coarse = known.clip.masks[2];
  Image image = known.clip.images[2];
  for (int y = 4; y < 9; ++y) {
    for (int x = 50; x < 56; ++x) {
      coarse[size_t(y) * MaskedClip::kWidth + x] = 1;
      image.pixel(x, y)[2] = 250;
    }
  }
  const LabelImage cut = *CutFromBackground(image, coarse, {}, known.background, known.person);
  EXPECT_EQ(cut.At(52, 6), 0);
  EXPECT_EQ(cut.At(40, 40), 1);
  const std::vector<uint8_t> nobody(coarse.size(), 0);
  EXPECT_TRUE(CutFromBackground(image, nobody, {}, known.background, known.person)->labels.empty());
  EXPECT_THROW(CutFromBackground(image, std::span(coarse).first(9), {}, known.background, known.person),
               std::invalid_argument);
  EXPECT_THROW(CutFromBackground(image, coarse, std::span(coarse).first(9), known.background, known.person),
               std::invalid_argument);
  EXPECT_THROW(CutFromBackground(image, coarse, {}, {}, known.person), std::invalid_argument);
}

TEST(ColourDensity, IsADensityOverAllColours) {
  ColourDensity density;
  const uint8_t red[3] = {10, 20, 200}, near[3] = {15, 16, 207}, far[3] = {16, 20, 200};
  EXPECT_DOUBLE_EQ(density.At(red), 1 / std::pow(256.0, 3));
  for (int i = 0; i < 3; ++i) density.Add(red);
  density.Add(far);
  EXPECT_DOUBLE_EQ(density.At(near), 0.1 / std::pow(256.0, 3) + 0.9 * 0.75 / 4096);
  EXPECT_DOUBLE_EQ(density.At(far), 0.1 / std::pow(256.0, 3) + 0.9 * 0.25 / 4096);
}

}  // namespace
}  // namespace bodyloom::background_cut_test
