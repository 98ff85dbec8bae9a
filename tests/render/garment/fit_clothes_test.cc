// SPDX-License-Identifier: Apache-2.0
/// Fits to masks of garments with finer, heavier and stiffer cloth than the fit's, at widths and lengths between those
/// it tries.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "render/garment/fit_clothes.h"

#include "geometry/body/normals.h"
#include "render/view/overlay.h"
#include "tests/render/garment/skirt_scene.h"

namespace bodyloom::fit_clothes_test {
namespace {

class FitClothesTest : public ::testing::Test {
 protected:
  const BodyModel& body_ = BuiltinBody();
};

TEST_F(FitClothesTest, FindsASkirtsLengthAndWidth) {
  for (const auto& [length_m, fullness, turn, swing] :
       {std::tuple{0.55, 0.5, 0.0, 0.0}, {0.72, 0.38, 0.6, 0.4}, {0.45, 0.66, 2.5, 0.0}}) {
    const Track photo = StandingPhoto(turn);
    const FittedClothes fitted = FitClothes(body_, photo, MaskOfSkirt(body_, photo, length_m, fullness, swing));
    ASSERT_GT(fitted.garment.length_m, 0)
        << length_m << ": " << fitted.mask_error_tight << " " << fitted.mask_error_with_garment;
    EXPECT_NEAR(fitted.swing_rad, swing, 0.26) << length_m;
    // Only the hem's position and the silhouette are observed; the pinned ring may be higher or lower, and wider cuts
    // of other cloth hang alike.
    EXPECT_NEAR(fitted.garment.waist_y_m - fitted.garment.length_m, body_.joint_template()(3, 1) - length_m, 0.06)
        << length_m;
    EXPECT_LT(fitted.mask_error_with_garment, 0.06);
    EXPECT_LT(fitted.mask_error_with_garment, fitted.mask_error_tight);
    EXPECT_EQ(fitted.garment.spacing_m, FitClothesOptions().spacing_m);
  }
}

TEST_F(FitClothesTest, FindsNoneOnABareBodyOrInWideTrousers) {
  for (const double turn : {0.0, 1.5}) {
    const Track photo = StandingPhoto(turn);
    const MatrixX3d vertices = TrackVertices(body_, photo, 0);
    const MatrixX3i& faces = body_.data().faces;
    const FittedClothes bare = FitClothes(body_, photo, MaskOf(vertices, faces, photo.camera));
    EXPECT_EQ(bare.garment.length_m, 0) << turn;
    EXPECT_LT(bare.mask_error_tight, 0.03) << turn;
    MatrixX3d wide = vertices;
    const MatrixX3f normals = VertexNormals(vertices, faces);
    const std::vector<uint8_t> legs =
        CoveredByGarment(body_, ShapeVertices(body_, photo.motion.betas), {.waist_y_m = 0.1, .length_m = 0.9});
    for (int v = 0; v < wide.rows(); ++v) {
      if (legs[v] != 0) wide.row(v) += 0.035 * normals.row(v).cast<double>();
    }
    const FittedClothes trousers = FitClothes(body_, photo, MaskOf(wide, faces, photo.camera));
    EXPECT_EQ(trousers.garment.length_m, 0) << turn;
  }
}

TEST_F(FitClothesTest, LooksForNoneWhenToldSoAndNeverForNobody) {
  const Track photo = StandingPhoto(0);
  const LabelImage mask = MaskOfSkirt(body_, photo, 0.55, 0.5, 0);
  FitClothesOptions options;
  options.loose = false;
  EXPECT_EQ(FitClothes(body_, photo, mask, options).garment.length_m, 0);
  LabelImage nobody = mask;
  std::fill(nobody.labels.begin(), nobody.labels.end(), 0);
  EXPECT_EQ(FitClothes(body_, photo, nobody).garment.length_m, 0);
}

TEST_F(FitClothesTest, ASkirtDoesNotMakeThighsWide) {
  const Track photo = StandingPhoto(0);
  const FittedClothes fitted = FitClothes(body_, photo, MaskOfSkirt(body_, photo, 0.55, 0.5, 0));
  const std::vector<uint8_t> covered =
      CoveredByGarment(body_, ShapeVertices(body_, photo.motion.betas), fitted.garment);
  int count = 0;
  for (int v = 0; v < body_.num_vertices(); ++v) {
    if (covered[v] == 0) continue;
    ++count;
    EXPECT_LT(std::abs(fitted.offsets.metres[v]), 0.01);
  }
  EXPECT_GT(count, 500);
}

TEST(GarmentSwing, TurnsUpInTheImageOnly) {
  const Track photo = StandingPhoto(0);
  EXPECT_LT((SwungUp(photo, 0) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);
  EXPECT_LT((SwungUp(photo, EIGEN_PI / 2) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
}

}  // namespace

}  // namespace bodyloom::fit_clothes_test
