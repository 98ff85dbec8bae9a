// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/clothes_details.h"

#include <gtest/gtest.h>

#include <array>

#include "data_tools/body/builtin_body.h"

namespace bodyloom::clothes_details_test {
namespace {

using Eigen::Vector3f;

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
}  // namespace bodyloom::clothes_details_test
