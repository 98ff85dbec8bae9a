// SPDX-License-Identifier: Apache-2.0
/// Symmetry of the body at rest: counterparts, and the nearest known point around a limb.
#include "render/texture/complete/texel_counterparts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "geometry/base/percentile.h"
#include "render/texture/body_regions.h"
#include "tests/render/garment/person_scene.h"

namespace bodyloom::rest_views_test {
namespace {

class RestViewsTest : public ::testing::Test {
 protected:
  [[nodiscard]] Eigen::Vector3d PlaceOf(const SurfacePoint& point) const {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      place += point.barycentric[k] * rest_.row(body_.data().faces(point.face, k)).transpose();
    return place;
  }
  const BodyModel& body_ = BuiltinBody();
  const MatrixX3d rest_ = ShapeVertices(body_, Eigen::VectorXd());
  const RestViews views_{rest_, body_.data().faces};
  const UvTexelTable table_ = BuildUvTexelTable(body_, {.width = 128, .height = 128, .gutter = 1});
  const MatrixX3d points_ = TexelPoints(rest_, body_.data().faces, table_);
};

TEST_F(RestViewsTest, NearlyEveryTexelIsSeenFromTheFrontOrFromBehind) {
  int seen = 0;
  for (Eigen::Index i = 0; i < points_.rows(); ++i) {
    if (!table_.in_gutter[i]) seen += views_.SideOf(points_.row(i).transpose()) ? 1 : 0;
  }
  EXPECT_GT(seen, 0.9 * table_.num_inside);  // the rest lies in folds: armpits, between fingers, inner thighs
}

TEST_F(RestViewsTest, CounterpartsLieWhereTheirNamesSay) {
  const TexelCounterparts counterparts = FindTexelCounterparts(views_, points_);
  int mirrored = 0;
  std::vector<double> beside, behind;
  for (Eigen::Index i = 0; i < points_.rows(); ++i) {
    if (table_.in_gutter[i]) continue;
    const Eigen::Vector3d point = points_.row(i).transpose();
    const SurfacePoint &mirror = counterparts[kMirror][i], &back = counterparts[kBehind][i];
    if (mirror.face >= 0) {
      const Eigen::Vector3d place = PlaceOf(mirror);
      beside.push_back((place.head<2>() - Eigen::Vector2d(-point.x(), point.y())).norm());
      mirrored += std::abs(place.z() - point.z()) < 0.01 ? 1 : 0;  // the built-in body is symmetric
    }
    if (back.face >= 0) behind.push_back((PlaceOf(back) - point).head<2>().norm());
  }
  EXPECT_GT(mirrored, 0.85 * table_.num_inside);
  EXPECT_GT(static_cast<double>(behind.size()), 0.85 * table_.num_inside);
  // A pixel is 1.8 mm; at the contour it shows the nearest that there is.
  EXPECT_LT(Percentile(beside, 90), 0.001);
  EXPECT_LT(Percentile(behind, 90), 0.001);
  EXPECT_LT(Percentile(beside, 100), 0.02);
  EXPECT_LT(Percentile(behind, 100), 0.022);
}

TEST_F(RestViewsTest, AroundALimbTheHeightStays) {
  // The front of the person's left half is known.
  const NearestAroundLimb nearest(body_, views_, [&](const SurfacePoint& point) {
    const Eigen::Vector3d place = PlaceOf(point);
    return place.x() > 0.02 && place.z() > 0;
  });
  const int wrist = body_.FindJoint("l_wrist"), shoulder = body_.FindJoint("l_shoulder");
  const double arm_begins = body_.joint_template()(shoulder, 0), hand_begins = body_.joint_template()(wrist, 0);
  int on_trunk = 0, on_arm = 0;
  for (Eigen::Index i = 0; i < points_.rows(); ++i) {
    const Eigen::Vector3d point = points_.row(i).transpose();
    const SurfacePoint found = nearest.At(point);
    if (found.face < 0) continue;
    const Eigen::Vector3d place = PlaceOf(found);
    EXPECT_GT(place.x(), 0);
    if (std::abs(point.x()) < 0.15 && point.y() < rest_.col(1).maxCoeff() - 0.5) {
      EXPECT_LT(std::abs(place.y() - point.y()), 0.006);
      ++on_trunk;
    } else if (point.x() > arm_begins + 0.1 && point.x() < hand_begins) {
      EXPECT_LT(std::abs(place.x() - point.x()), 0.006);
      ++on_arm;
    }
  }
  EXPECT_GT(on_trunk, 1000);
  EXPECT_GT(on_arm, 200);
}

TEST_F(RestViewsTest, RegionsLieWhereTheirNamesSay) {
  const std::vector<BodyRegion> regions = BodyRegions(body_, rest_);
  const auto at = [&](const char* name) {
    return regions[body_.data().landmarks[body_.FindLandmark(name)].vertices[0]];
  };
  EXPECT_EQ(at("nose"), BodyRegion::kFace);
  EXPECT_EQ(at("left_eye"), BodyRegion::kFace);
  EXPECT_EQ(at("left_ear"), BodyRegion::kScalp);
  EXPECT_EQ(at("left_heel"), BodyRegion::kElsewhere);
  int top = 0;
  rest_.col(1).maxCoeff(&top);
  EXPECT_EQ(regions[top], BodyRegion::kScalp);
  int fingertip = 0;
  rest_.col(0).maxCoeff(&fingertip);
  EXPECT_EQ(regions[fingertip], BodyRegion::kHand);
  BodyModelData without = body_.data();
  without.landmarks.clear();
  for (const BodyRegion region : BodyRegions(BodyModel(std::move(without)), rest_)) {
    EXPECT_TRUE(region == BodyRegion::kElsewhere || region == BodyRegion::kHand);
  }
}

}  // namespace
}  // namespace bodyloom::rest_views_test
