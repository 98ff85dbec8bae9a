// SPDX-License-Identifier: Apache-2.0
#include "render/garment/clothes_offsets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "geometry/base/percentile.h"
#include "geometry/body/normals.h"
#include "render/texture/body_regions.h"
#include "tests/render/garment/person_scene.h"

namespace bodyloom::clothes_offsets_test {
namespace {

class ClothesOffsetsTest : public ::testing::Test {
 protected:
  [[nodiscard]] ClothesOffsets Fit(const LabelImage& mask) const {
    return FitClothesOffsets(body_, rest_, vertices_, camera_, mask);
  }
  /// The body with every vertex moved along its normal.
  [[nodiscard]] MatrixX3d Inflated(double metres) const {
    return vertices_ + metres * VertexNormals(vertices_, body_.data().faces).cast<double>();
  }
  /// Offsets of the trunk, thighs and calves: the vertices that move most with these joints.
  [[nodiscard]] std::vector<double> OfTrunkAndLegs(const ClothesOffsets& offsets) const {
    std::vector<double> found;
    for (int v = 0; v < body_.num_vertices(); ++v) {
      for (int k = body_.influence_begin()[v]; k < body_.influence_begin()[v + 1]; ++k) {
        const std::string& name = body_.data().joint_names[body_.influence_joint()[k]];
        if (body_.influence_weight()[k] < 0.7) continue;
        if (name == "spine1" || name == "spine2" || name == "l_hip" || name == "r_hip" || name == "l_knee") {
          found.push_back(offsets.metres[v]);
        }
      }
    }
    return found;
  }

  const BodyModel& body_ = BuiltinBody();
  const Camera camera_ = PersonCamera();
  const MatrixX3d rest_ = ShapeVertices(body_, Eigen::VectorXd());
  const MatrixX3d vertices_ = StandingBefore(body_, 0.3);
};

TEST_F(ClothesOffsetsTest, OfABareBodyAreNothing) {
  const ClothesOffsets offsets = Fit(MaskOf(vertices_, body_.data().faces, camera_));
  EXPECT_GT(offsets.measured, 300);
  std::vector<double> sizes = offsets.metres;
  for (double& size : sizes) size = std::abs(size);
  EXPECT_LT(Percentile(sizes, 99), 0.004);  // a pixel is 3.3 mm
}

TEST_F(ClothesOffsetsTest, OfAnInflatedBodyAreItsOffset) {
  for (const double metres : {0.02, 0.05}) {
    const std::vector<double> found = OfTrunkAndLegs(Fit(MaskOf(Inflated(metres), body_.data().faces, camera_)));
    ASSERT_GT(found.size(), 500U);
    EXPECT_NEAR(Percentile(found, 50), metres, 0.15 * metres);
    EXPECT_GT(Percentile(found, 5), 0.5 * metres);
    EXPECT_LT(Percentile(found, 95), 1.3 * metres);
  }
}

TEST_F(ClothesOffsetsTest, DrawTheBodyInNoFurtherThanAllowed) {
  const ClothesOffsets offsets = Fit(MaskOf(Inflated(-0.02), body_.data().faces, camera_));
  EXPECT_NEAR(Percentile(OfTrunkAndLegs(offsets), 50), -0.02, 0.005);
  EXPECT_GE(*std::min_element(offsets.metres.begin(), offsets.metres.end()), -0.03);
}

TEST_F(ClothesOffsetsTest, FaceAndHandsKeepTheirShape) {
  const ClothesOffsets offsets = Fit(MaskOf(Inflated(0.05), body_.data().faces, camera_));
  const std::vector<BodyRegion> regions = BodyRegions(body_, rest_);
  std::vector<double> kept;
  for (int v = 0; v < body_.num_vertices(); ++v) {
    if (regions[v] == BodyRegion::kFace || regions[v] == BodyRegion::kHand) kept.push_back(offsets.metres[v]);
  }
  ASSERT_FALSE(kept.empty());
  EXPECT_LT(Percentile(kept, 95), 0.012);
}

TEST_F(ClothesOffsetsTest, WhatEndsNowhereIsNotMeasured) {
  LabelImage everything{0, 0, camera_.width, camera_.height, {}};
  everything.labels.assign(size_t(camera_.width) * camera_.height, 1);
  const ClothesOffsets offsets = Fit(everything);
  EXPECT_EQ(offsets.measured, 0);
  EXPECT_EQ(*std::max_element(offsets.metres.begin(), offsets.metres.end()), 0);
  EXPECT_EQ(Fit(LabelImage{}).measured, 0) << "no mask at all";
}

TEST_F(ClothesOffsetsTest, RefusesOtherSizes) {
  EXPECT_THROW(FitClothesOffsets(body_, rest_.topRows(10), vertices_, camera_, LabelImage{}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::clothes_offsets_test
