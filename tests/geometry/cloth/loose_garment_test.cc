// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/loose_garment.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/support/toy_body.h"

namespace bodyloom::loose_garment_test {
namespace {

using Eigen::Vector3d;

TEST(LooseGarment, IsSewnAsItsPatternSays) {
  const BodyModel& body = ToyBody();
  for (const double slit_m : {-1.0, 0.25}) {
    LooseGarmentOptions options;
    options.waist_y_m = 0.09, options.length_m = 0.55, options.fullness = 0.5, options.slit_from_m = slit_m;
    const MatrixX3d& vertices = body.data().v_template;
    const LooseGarment g = CutLooseGarment(vertices, body.data().faces, 0.3, options);
    const int closed = slit_m < 0 ? g.rings : static_cast<int>(slit_m / (0.55 / (g.rings - 1)));
    EXPECT_EQ(int(g.sewn.size()), closed * g.columns + (g.rings - closed) * (g.columns + 1));
    EXPECT_EQ(int(g.pins.size()), g.columns);
    const std::vector<Vector3d> pinned = PinnedPlaces(g.pins, vertices, body.data().faces);
    for (int j = 0; j < g.columns; ++j) {
      EXPECT_EQ(g.cloth.mass_kg[j], 0);
      EXPECT_NEAR((pinned[j] - g.sewn[j]).norm(), 0, 0.012) << "lifted along the face, sewn outwards";
      EXPECT_NEAR(g.sewn[j].y(), 0.09, 1e-9);
      const int hem = int(g.sewn.size()) - g.columns - (slit_m < 0 ? 0 : 1) + j;
      EXPECT_NEAR((g.sewn[hem] - g.sewn[j]).norm(), 0.55, 1e-9) << "path from waist to hem";
      EXPECT_NEAR(g.sewn[j].y() - g.sewn[hem].y(), 0.55 * std::sqrt(0.75), 1e-9);
    }
    double mass = 0, area = 0, outwards = 1;
    for (const double m : g.cloth.mass_kg) mass += m;
    for (int f = 0; f < g.cloth.faces.rows(); ++f) {
      const Vector3d a = g.sewn[g.cloth.faces(f, 0)], b = g.sewn[g.cloth.faces(f, 1)], c = g.sewn[g.cloth.faces(f, 2)];
      const Vector3d n = (b - a).cross(c - a);
      area += 0.5 * n.norm();
      outwards = std::min(outwards, n.normalized().dot(Vector3d(a.x(), 0, a.z()).normalized()));
      for (int k = 0; k < 3; ++k) EXPECT_EQ(g.drawn_from[g.drawn_faces(f, k)], g.cloth.faces(f, k));
      // No step of the pattern inside a face.
      EXPECT_LT((g.pattern.row(g.drawn_faces(f, 0)) - g.pattern.row(g.drawn_faces(f, 2))).norm(), 0.06);
    }
    EXPECT_GT(outwards, 0.3);
    EXPECT_LT(mass, 0.25 * area) << "the pinned ring's own share is not carried";
    EXPECT_GT(mass, 0.9 * 0.25 * area);
    EXPECT_NEAR(LargestStretch(g.cloth, g.sewn), 0, 1e-12);
  }
  EXPECT_THROW(CutLooseGarment(body.data().v_template, body.data().faces, 0.3, {.waist_y_m = 5}),
               std::invalid_argument);
  EXPECT_THROW(CutLooseGarment(body.data().v_template, body.data().faces, 0.3, {.fullness = 1}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::loose_garment_test
