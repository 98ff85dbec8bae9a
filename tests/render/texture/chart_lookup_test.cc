// SPDX-License-Identifier: Apache-2.0
#include "render/texture/chart_lookup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/raster/visible_points.h"
#include "tests/support/toy_body.h"

namespace bodyloom::chart_lookup_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

TEST(ChartLookup, InvertsTheCharts) {
  const ChartLookup lookup(ToyBody());
  std::mt19937 generator(1);
  const auto uniform = [&] { return generator() / 4294967296.0; };
  for (int f = 0; f < ToyBody().num_faces(); ++f) {
    Vector3d b{uniform(), uniform(), uniform()};
    b = (b / b.sum() * 0.9).array() + 0.1 / 3;  // inside
    const Vector2d uv = ChartUvAt(ToyBody(), f, b).cast<double>();
    double gap = -1;
    const SurfacePoint point = lookup.Find(ToyBody().data().face_part[f], uv, &gap);
    ASSERT_EQ(point.face, f);
    EXPECT_LT((point.barycentric - b).norm(), 2e-5);  // chart coordinates are floats
    EXPECT_EQ(gap, 0);
  }
}

TEST(ChartLookup, FindsTheNearestPointOutsideAChart) {
  const ChartLookup lookup(ToyBody());
  std::mt19937 generator(2);
  const auto uniform = [&] { return generator() / 4294967296.0; };
  for (int i = 0; i < 500; ++i) {
    const int part = 1 + i % 24;
    const Vector2d uv{3 * uniform() - 1, 3 * uniform() - 1};
    double gap = -1;
    const SurfacePoint point = lookup.Find(part, uv, &gap);
    ASSERT_GE(point.face, 0);
    EXPECT_EQ(ToyBody().data().face_part[point.face], part);
    EXPECT_GE(point.barycentric.minCoeff(), 0);
    EXPECT_NEAR(point.barycentric.sum(), 1, 1e-9);
    EXPECT_NEAR((ChartUvAt(ToyBody(), point.face, point.barycentric).cast<double>() - uv).norm(), gap, 1e-6);
    // No sampled point of the chart is nearer.
    for (int f = 0; f < ToyBody().num_faces(); ++f) {
      if (ToyBody().data().face_part[f] != part) continue;
      for (const Vector3d& b :
           {Vector3d(1, 0, 0), Vector3d(0.5, 0.5, 0), Vector3d(0, 0.5, 0.5), Vector3d(0.2, 0.3, 0.5)}) {
        ASSERT_GE((ChartUvAt(ToyBody(), f, b).cast<double>() - uv).norm(), gap - 1e-6) << "part " << part;
      }
    }
  }
}

TEST(ChartLookup, RefusesWhatIsNoChartCoordinate) {
  const ChartLookup lookup(ToyBody());
  EXPECT_EQ(lookup.Find(0, Vector2d(0.5, 0.5)).face, -1);
  EXPECT_EQ(lookup.Find(25, Vector2d(0.5, 0.5)).face, -1);
  EXPECT_EQ(lookup.Find(-3, Vector2d(0.5, 0.5)).face, -1);
  EXPECT_EQ(lookup.Find(2, Vector2d(std::nan(""), 0.5)).face, -1);
  BodyModelData data = ToyBodyData();
  data.face_iuv.resize(0, 6);
  EXPECT_THROW(ChartLookup(BodyModel(std::move(data))), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::chart_lookup_test
