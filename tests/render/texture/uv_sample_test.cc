// SPDX-License-Identifier: Apache-2.0
#include "render/texture/uv_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/support/meshes.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::uv_sample_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double Sum(const UvTaps& taps, const std::vector<float>& map) {
  double sum = 0;
  for (int k = 0; k < taps.count; ++k) sum += taps.weight[k] * map[taps.pixel[k]];
  return sum;
}

TEST(UvSample, IsExactForLinearMapsAndKeepsChartsApart) {
  const BodyModel body(SphereOfOctants(3));
  const UvCharts charts = FindUvCharts(body);
  const UvTexelTable table = BuildUvTexelTable(body);
  // Each chart has a plane of its own; what lies outside all charts is a value that would be noticed.
  std::vector<float> map(128 * 128, 1e6F);
  const auto plane = [](int chart, double u, double v) { return 100 * chart + 3 * u - 2 * v; };
  for (int p = 0; p < 128 * 128; ++p) {
    if (table.chart_at[p] < 0) continue;
    const int column = p % 128, row = p / 128;
    map[p] = static_cast<float>(plane(table.chart_at[p], (column + 0.5) / 128, 1 - (row + 0.5) / 128));
  }
  int whole = 0;
  for (int f = 0; f < body.num_faces(); ++f) {
    for (const Vector3d& b : {Vector3d(1, 0, 0), Vector3d(0.4, 0.6, 0), Vector3d(0.3, 0.3, 0.4)}) {
      const UvPoint point = UvPointAt(body, charts, f, b);
      const UvTaps taps = TapsAt(table, point);
      ASSERT_GT(taps.count, 0);
      whole += taps.whole;
      ASSERT_TRUE(taps.whole) << "the gutter of one texel is enough for every lookup on the surface";
      ASSERT_NEAR(Sum(taps, map), plane(point.chart, point.uv.x(), point.uv.y()), 1e-3);
    }
  }
  EXPECT_EQ(whole, 3 * body.num_faces());
}

TEST(UvSample, DerivativesAreThoseOfTheValue) {
  const BodyModel body(SphereOfOctants(3));
  const UvTexelTable table =
      BuildUvTexelTable(body, {.gutter = 0});  // so that taps are missing at the charts' boundaries
  const UvCharts charts = FindUvCharts(body);
  std::vector<float> map(128 * 128);
  for (size_t p = 0; p < map.size(); ++p) {
    const size_t column = p % 128, row = p / 128;
    map[p] = static_cast<float>(std::sin(0.3 * double(column)) + 0.02 * double(row));
  }
  int partial = 0, checked = 0;
  for (int i = 0; i < 2 * body.num_faces(); ++i) {
    const UvPoint point =
        UvPointAt(body, charts, i / 2, i % 2 ? Vector3d(0.52, 0.27, 0.21) : Vector3d(0.93, 0.04, 0.03));
    const UvTaps taps = TapsAt(table, point);
    if (taps.count == 0) continue;
    const double h = 1e-6;
    Vector2d found = Vector2d::Zero(), expected;
    for (int k = 0; k < taps.count; ++k) found += taps.d_weight[k] * map[taps.pixel[k]];
    bool same = true;
    for (int axis = 0; axis < 2; ++axis) {
      UvPoint low = point, high = point;
      low.uv[axis] -= h;
      high.uv[axis] += h;
      const UvTaps a = TapsAt(table, low), b = TapsAt(table, high);
      same = same && a.count == taps.count && b.count == taps.count && a.pixel == taps.pixel && b.pixel == taps.pixel;
      expected[axis] = (Sum(b, map) - Sum(a, map)) / (2 * h);
    }
    if (!same) continue;  // on the line between two texels
    ++checked;
    partial += !taps.whole;
    ASSERT_LT((found - expected).norm(), 1e-4 * (1 + expected.norm()));
  }
  EXPECT_GT(checked, 400);
  EXPECT_GT(partial, 20);
}

TEST(UvSample, OutsideEverythingThereIsNothing) {
  const BodyModel body(SphereOfOctants(2));
  const UvTexelTable table = BuildUvTexelTable(body);
  EXPECT_EQ(TapsAt(table, {Vector2d(0.5, 0.5), -2}).count, 0);
  EXPECT_EQ(TapsAt(table, {Vector2d(7, -3), 0}).count, 0);
  EXPECT_EQ(TapsAt(table, {Vector2d(std::nan(""), 0.5), 0}).count, 0);
}

TEST(UvSample, ProjectsMapsWhereTheSurfaceIsSeen) {
  const BodyModel& body = ToyBody();
  const Camera camera = MakePinhole(120, 120, 140);
  const MatrixX3d vertices = PoseVertices(body, Eigen::VectorXd(), RandomPose(body, 7, 0.8, 2.5));
  VisibilityBuffer buffer;
  buffer.Render(vertices, body.data().faces, camera);
  const VisiblePoints points = ResolveVisiblePoints(buffer, body, vertices, camera);
  const UvCharts charts = FindUvCharts(body);
  const UvTexelTable table = BuildUvTexelTable(body, charts, {.width = 256, .height = 256});
  // The map of the template's positions: what a pixel shows is known from its surface point.
  std::vector<float> maps(3 * 256 * 256, 0.0F);
  for (size_t i = 0; i < table.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const auto corner = body.data().v_template.row(body.data().faces(table.face[i], k));
      for (int c = 0; c < 3; ++c) {
        maps[c * 65536 + table.pixel[i]] += table.barycentric[i][k] * static_cast<float>(corner[c]);
      }
    }
  }
  const std::vector<float> image = ProjectUvMaps(body, charts, table, maps, 3, points, 120, 120);
  std::vector<char> covered(120 * 120, 0);
  double squares = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const int p = points.y[i] * 120 + points.x[i];
    covered[p] = 1;
    for (int c = 0; c < 3; ++c) {
      double exact = 0;
      for (int k = 0; k < 3; ++k) {
        exact += points.barycentric[i][k] * body.data().v_template(body.data().faces(points.face[i], k), c);
      }
      squares += std::pow(image[c * 14400 + p] - exact, 2);
    }
  }
  EXPECT_LT(std::sqrt(squares / points.size()), 0.003);  // metres; a texel is about 1 cm
  for (int p = 0; p < 14400; ++p) {
    if (!covered[p]) {
      ASSERT_EQ(image[p], 0);
    }
  }
  EXPECT_THROW((void)ProjectUvMaps(body, charts, table, maps, 4, points, 120, 120), std::invalid_argument);
  EXPECT_THROW((void)ProjectUvMaps(body, charts, table, maps, 3, points, 60, 60), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::uv_sample_test
