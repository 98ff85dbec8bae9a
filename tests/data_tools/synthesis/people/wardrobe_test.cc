// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "data_tools/synthesis/people/wardrobe.h"

#include "data_tools/body/builtin_body.h"

namespace bodyloom::wardrobe_test {
namespace {

using Eigen::Vector3f;

constexpr double kAround_m = 2.1;
constexpr PersonLabel kTop = PersonLabel::kTop, kBottom = PersonLabel::kBottom;

Wardrobe WardrobeOf(GarmentKind kind, uint64_t seed, ClothesStyle style = ClothesStyle::kPatterned) {
  return {Outfit(BuiltinBody(), kind, seed, style), kind == GarmentKind::kSuit ? 0 : kAround_m, seed};
}

TEST(Wardrobe, EveryPatternButThePlainOneShowsBothColoursOnLooseCloth) {
  std::array<int, 5> garments{};
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    for (const GarmentKind kind : {GarmentKind::kSkirt, GarmentKind::kCoat}) {
      const Wardrobe wardrobe = WardrobeOf(kind, seed);
      const SurfacePattern& pattern = wardrobe.of_label(kind == GarmentKind::kCoat ? kTop : kBottom);
      ++garments[size_t(pattern.kind)];
      if (pattern.kind == PatternKind::kPlain || pattern.kind == PatternKind::kNoise) continue;
      int other = 0, all = 0;
      for (float y = 0; y < 0.6F; y += 0.004F) {
        for (float x = 0; x < static_cast<float>(kAround_m); x += 0.004F, ++all) {
          const Vector3f colour = wardrobe.OfGarment({x, y, 0});
          ASSERT_TRUE(colour == pattern.colour || colour == pattern.other);
          other += colour == pattern.other ? 1 : 0;
        }
      }
      const double share = double(other) / all;
      // Dots are discs of radius 0.36 in squares of 1.
      EXPECT_NEAR(share, pattern.kind == PatternKind::kDots ? M_PI * 0.36 * 0.36 : 0.5, 0.06)
          << int(pattern.kind) << " of seed " << seed;
    }
  }
  for (const PatternKind kind : {PatternKind::kStripes, PatternKind::kChecks, PatternKind::kDots}) {
    EXPECT_GT(garments[size_t(kind)], 5) << int(kind);
  }
}

TEST(Wardrobe, TheLooseGarmentMeetsItself) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    const Wardrobe wardrobe = WardrobeOf(GarmentKind::kSkirt, seed);
    if (wardrobe.of_label(kBottom).kind == PatternKind::kNoise) continue;  // has no period
    int differ = 0;
    for (float x = 0.0013F; x < 0.5F; x += 0.01F) {
      for (float y = 0.0017F; y < 0.5F; y += 0.01F) {
        differ += wardrobe.OfGarment({x, y, 0}) != wardrobe.OfGarment({x + static_cast<float>(kAround_m), y, 0});
      }
    }
    EXPECT_LT(differ, 25) << "of 2500, by rounding, seed " << seed;
  }
}

TEST(Wardrobe, AFifthIsPlainAndTwoPatternsDiffer) {
  constexpr int kPeople = 2000;
  std::array<int, 5> tops{}, bottoms{};
  int both_plain = 0;
  for (uint64_t seed = 1; seed <= kPeople; ++seed) {
    const Wardrobe wardrobe = WardrobeOf(GarmentKind::kSuit, seed);
    const PatternKind top = wardrobe.of_label(kTop).kind, bottom = wardrobe.of_label(kBottom).kind;
    ++tops[size_t(top)], ++bottoms[size_t(bottom)];
    both_plain += top == PatternKind::kPlain && bottom == top ? 1 : 0;
    EXPECT_TRUE(top != bottom || top == PatternKind::kPlain) << seed;
    EXPECT_NE(wardrobe.of_label(kTop).colour, wardrobe.of_label(kBottom).colour);
    if (top != PatternKind::kPlain) continue;
    const Vector3f colour = wardrobe.of_label(kTop).colour;
    for (float y = 0; y < 0.5F; y += 0.03F) EXPECT_EQ(wardrobe.OfBody(kTop, {0.1F, y, 0.05F}), colour);
  }
  // Five standard deviations of 2000 draws.
  for (const auto& kinds : {tops, bottoms}) {
    for (const int count : kinds) EXPECT_NEAR(count, kPeople / 5.0, 90);
  }
  EXPECT_NEAR(both_plain, kPeople / 25.0, 45);
}

/// The largest channel less the smallest, as a share of the largest.
float Saturation(const Vector3f& colour) { return 1 - colour.minCoeff() / std::max(1.0F, colour.maxCoeff()); }

TEST(Wardrobe, EverydayClothesAreMostlyPlainAndHalfOfThemGrey) {
  constexpr int kPeople = 2000;
  std::array<int, 6> tops{}, bottoms{};
  int grey_tops = 0;
  for (uint64_t seed = 1; seed <= kPeople; ++seed) {
    const Wardrobe wardrobe = WardrobeOf(GarmentKind::kSuit, seed, ClothesStyle::kEveryday);
    const SurfacePattern &top = wardrobe.of_label(kTop), &bottom = wardrobe.of_label(kBottom);
    ++tops[size_t(top.kind)], ++bottoms[size_t(bottom.kind)];
    grey_tops += Saturation(top.colour) <= 0.081F ? 1 : 0;
  }
  // Five standard deviations of 2000 draws. Plain cloth fades, so it counts as noise, as 6 % of tops and 7 % of
  // bottoms.
  EXPECT_NEAR(tops[size_t(PatternKind::kNoise)], 0.66 * kPeople, 106);
  EXPECT_NEAR(tops[size_t(PatternKind::kPrint)], 0.1 * kPeople, 67);
  EXPECT_NEAR(tops[size_t(PatternKind::kStripes)], 0.12 * kPeople, 73);
  EXPECT_NEAR(bottoms[size_t(PatternKind::kNoise)], 0.82 * kPeople, 86);
  EXPECT_EQ(bottoms[size_t(PatternKind::kPrint)], 0);
  EXPECT_NEAR(grey_tops, 0.5 * kPeople, 112);
}

TEST(Wardrobe, APrintIsOnTheChestAlone) {
  int prints = 0;
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    for (const GarmentKind kind : {GarmentKind::kSuit, GarmentKind::kCoat}) {
      const Wardrobe wardrobe = WardrobeOf(kind, seed, ClothesStyle::kEveryday);
      const SurfacePattern& top = wardrobe.of_label(kTop);
      if (top.kind != PatternKind::kPrint) continue;
      ASSERT_EQ(kind, GarmentKind::kSuit) << "a coat's cloth has other coordinates";
      ++prints;
      const Vector3f middle = top.print.center();
      int printed = 0;
      for (float y = middle.y() - 0.4F; y < middle.y() + 0.4F; y += 0.004F) {
        for (float x = -0.3F; x < 0.3F; x += 0.004F) {
          EXPECT_EQ(top.At({x, y, middle.z() - 0.6F}), top.colour) << "the back";
          const bool is_printed = top.At({x, y, middle.z()}) != top.colour;
          EXPECT_TRUE(!is_printed || top.print.contains(Vector3f(x, y, middle.z())));
          printed += is_printed ? 1 : 0;
        }
      }
      EXPECT_GT(printed, 10) << seed;
    }
  }
  EXPECT_GT(prints, 2);
}

const Vector3f kCloth(90, 100, 110);

/// The places of a body's surface that have a label.
std::vector<Vector3f> PlacesOf(const Outfit& outfit, PersonLabel label) {
  std::vector<Vector3f> places;
  const MatrixX3d& vertices = BuiltinBody().data().v_template;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    const Eigen::Vector3d p = vertices.row(v).transpose();
    if (outfit.LabelAt(p) == label) places.push_back(p.cast<float>());
  }
  return places;
}

TEST(ClothesDetails, MostPeopleHaveSomeAndMostOfTheirClothHasNone) {
  constexpr int kPeople = 300;
  for (const PersonLabel label : {PersonLabel::kTop, PersonLabel::kBottom, PersonLabel::kShoes}) {
    int with_details = 0;
    double changed_share = 0;
    for (uint64_t seed = 1; seed <= kPeople; ++seed) {
      const Outfit outfit(BuiltinBody(), GarmentKind::kSuit, seed, ClothesStyle::kEveryday);
      const ClothesDetails details(outfit, seed), again(outfit, seed);
      int changed = 0;
      const std::vector<Vector3f> places = PlacesOf(outfit, label);
      for (const Vector3f& p : places) {
        const Vector3f colour = details.On(label, p, kCloth);
        ASSERT_EQ(colour, again.On(label, p, kCloth));
        ASSERT_TRUE((colour.array() >= 0).all() && (colour.array() <= 255).all());
        changed += (colour - kCloth).cwiseAbs().maxCoeff() > 20 ? 1 : 0;
      }
      with_details += changed > 0 ? 1 : 0;
      changed_share += places.empty() ? 0 : static_cast<double>(changed) / static_cast<double>(places.size()) / kPeople;
    }
    EXPECT_GT(with_details, kPeople / 3) << static_cast<int>(label);
    EXPECT_LT(with_details, kPeople * 49 / 50) << static_cast<int>(label);
    EXPECT_GT(changed_share, 0.02) << static_cast<int>(label);
    EXPECT_LT(changed_share, 0.4) << static_cast<int>(label);
  }
}

TEST(ClothesDetails, AnOpenJacketShowsOneColourInFrontAlone) {
  int open = 0;
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    const Outfit outfit(BuiltinBody(), GarmentKind::kSuit, seed, ClothesStyle::kEveryday);
    if (!outfit.has_top()) continue;
    const ClothesDetails details(outfit, seed);
    const OutfitCut& c = outfit.cut();
    const auto at = [&](double x, double z) {
      return details.On(PersonLabel::kTop, {float(c.neck_x + x), float(0.5 * (c.neck_y + c.waist_y)), float(z)},
                        kCloth);
    };
    const Vector3f middle = at(0, c.neck_z + 0.1), beside = at(0.015, c.neck_z + 0.1);
    if (middle != beside || (middle - kCloth).cwiseAbs().maxCoeff() < 20) continue;
    ++open;
    EXPECT_LT((at(0, c.neck_z - 0.1) - kCloth).cwiseAbs().maxCoeff(), 20) << "the back, seed " << seed;
    EXPECT_LT((at(0.09, c.neck_z + 0.1) - kCloth).cwiseAbs().maxCoeff(), 20) << "the side, seed " << seed;
  }
  EXPECT_NEAR(open, 0.15 * 0.96 * 300, 31);
}

TEST(ClothesDetails, SkinFaceAndHairHaveNone) {
  const Outfit outfit(BuiltinBody(), GarmentKind::kSuit, 1, ClothesStyle::kEveryday);
  const ClothesDetails details(outfit, 1);
  for (const PersonLabel label : {PersonLabel::kSkin, PersonLabel::kFace, PersonLabel::kHair}) {
    for (const Vector3f& p : PlacesOf(outfit, label)) ASSERT_EQ(details.On(label, p, kCloth), kCloth);
  }
}

}  // namespace

}  // namespace bodyloom::wardrobe_test
