// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/uv_texels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/meshes.h"
#include "tests/support/toy_body.h"

namespace bodyloom::uv_texels_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kDegree = M_PI / 180;

Vector3d PointOf(const BodyModel& body, int face, const Eigen::Vector3f& barycentric) {
  Vector3d p = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    p += double{barycentric[k]} * body.data().v_template.row(body.data().faces(face, k)).transpose();
  }
  return p;
}

Vector2d UvOf(const BodyModel& body, int face, const Eigen::Vector3d& barycentric) {
  Vector2d uv = Vector2d::Zero();
  for (int k = 0; k < 3; ++k)
    uv += barycentric[k] * body.data().vt.row(body.data().ft(face, k)).transpose().cast<double>();
  return uv;
}

Vector2d CentreUv(const UvTexelTable& table, int pixel) {
  const int row = pixel / table.width;
  return {(pixel % table.width + 0.5) / table.width, 1 - (row + 0.5) / table.height};
}

TEST(UvCharts, OfTheSphereAreItsOctants) {
  const BodyModel body(SphereOfOctants(3));
  const UvCharts charts = FindUvCharts(body);
  EXPECT_EQ(charts.num_charts, 8);
  EXPECT_EQ(charts.mesh.num_boundary_edges, 0);
  // Each octant has three sides of eight edges, each edge a seam from both of its faces.
  EXPECT_EQ(std::count(charts.is_seam.begin(), charts.is_seam.end(), 1), 8 * 3 * 8);
}

TEST(UvCharts, AreTheSameWhenEveryFaceBringsItsOwnUvs) {
  BodyModelData data = SphereOfOctants(2);
  MatrixX2f vt(3 * data.ft.rows(), 2);
  for (Eigen::Index f = 0; f < data.ft.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      vt.row(3 * f + k) = data.vt.row(data.ft(f, k));
      data.ft(f, k) = static_cast<int>(3 * f + k);
    }
  }
  const UvCharts before = FindUvCharts(BodyModel(SphereOfOctants(2)));
  data.vt = vt;
  const UvCharts after = FindUvCharts(BodyModel(data));
  EXPECT_EQ(after.chart, before.chart);
  EXPECT_EQ(after.is_seam, before.is_seam);
}

TEST(UvTexels, ShowTheFaceThatABruteForceSearchFinds) {
  for (const BodyModelData& data : {SphereOfOctants(2), ToyBodyData()}) {
    const BodyModel body(data);
    for (const auto& [width, height] : {std::pair{64, 64}, {37, 29}, {128, 50}}) {
      const UvTexelTable table = BuildUvTexelTable(body, {.width = width, .height = height, .gutter = 0});
      std::vector<int> shown(width * height, -1);
      for (size_t i = 0; i < table.size(); ++i) shown[table.pixel[i]] = table.face[i];
      int covered = 0;
      for (int p = 0; p < width * height; ++p) {
        const Vector2d uv = CentreUv(table, p);
        int expected = -1;
        double margin = 1;
        for (int f = 0; f < body.num_faces(); ++f) {
          Eigen::Matrix3d corners;
          for (int k = 0; k < 3; ++k) corners.col(k) << data.vt.row(data.ft(f, k)).transpose().cast<double>(), 1;
          const Vector3d b = corners.inverse() * Vector3d(uv.x(), uv.y(), 1);
          margin = std::min(margin, b.cwiseAbs().minCoeff());
          if (expected < 0 && b.minCoeff() >= 0) expected = f;
        }
        if (margin < 1e-6) continue;  // on an edge either answer is right
        covered += expected >= 0;
        ASSERT_EQ(shown[p], expected) << "texel " << p % width << " " << p / width;
      }
      EXPECT_GT(covered, width * height / 8);
      EXPECT_EQ(table.overlapping, 0);
    }
  }
}

TEST(UvTexels, LieWhereTheirUvSays) {
  const BodyModel body(SphereOfOctants(3));
  const UvTexelTable table = BuildUvTexelTable(body);
  const UvCharts charts = FindUvCharts(body);
  EXPECT_TRUE(std::is_sorted(table.pixel.begin(), table.pixel.end()));
  EXPECT_EQ(table.num_inside + table.num_gutter, static_cast<int>(table.size()));
  EXPECT_GT(table.num_gutter, 100);
  for (size_t i = 0; i < table.size(); ++i) {
    ASSERT_GE(table.barycentric[i].minCoeff(), 0);
    ASSERT_NEAR(table.barycentric[i].sum(), 1, 1e-6);
    if (table.in_gutter[i]) {
      ASSERT_NE(table.chart_at[table.pixel[i]], charts.chart[table.face[i]]);  // it shows the face across the seam
      continue;
    }
    ASSERT_EQ(table.chart_at[table.pixel[i]], charts.chart[table.face[i]]);
    const Vector2d uv = UvOf(body, table.face[i], table.barycentric[i].cast<double>());
    ASSERT_LT((uv - CentreUv(table, table.pixel[i])).norm(), 1e-6);
  }
}

/// A flat sheet of n×n quads, cut at its middle: the left half lies upright in the map, the right half is turned by 90°
/// and smaller.
BodyModelData CutSheet(int n, bool flip_some_faces) {
  TestMesh sheet{MatrixX3d((n + 1) * (n + 1), 3), MatrixX3i(2 * n * n, 3)};
  MatrixX2f vt(2 * (n + 1) * (n + 1), 2);
  MatrixX3i ft(2 * n * n, 3);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      sheet.vertices.row(j * (n + 1) + i) << x, y, 0;
      vt.row(j * (n + 1) + i) << static_cast<float>(0.05 + 0.7 * x), static_cast<float>(0.1 + 0.8 * y);
      vt.row((n + 1) * (n + 1) + j * (n + 1) + i) << static_cast<float>(0.5 + 0.4 * y),
          static_cast<float>(0.9 - 0.5 * (x - 0.5));
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      const int shift = i >= n / 2 ? (n + 1) * (n + 1) : 0, f = 2 * (j * n + i);
      sheet.faces.row(f) << a, b, c;
      sheet.faces.row(f + 1) << a, c, d;
      if (flip_some_faces && i % 2 == 1) sheet.faces.row(f).reverseInPlace();
      ft.row(f) = sheet.faces.row(f).array() + shift;
      ft.row(f + 1) = sheet.faces.row(f + 1).array() + shift;
    }
  }
  return BodyOfMesh(sheet, vt, ft);
}

TEST(UvTexels, InTheGutterFollowTheSurfaceAcrossTheSeam) {
  // On a flat sheet the surface beyond a seam is the plane: where a gutter texel lies is known in closed form, from the
  // map of its own chart.
  for (const bool flip : {false, true}) {
    const BodyModel body(CutSheet(16, flip));
    const int size = 96, gutter = 3;
    const UvTexelTable table = BuildUvTexelTable(body, {.width = size, .height = size, .gutter = gutter});
    ASSERT_EQ(table.num_charts, 2);
    EXPECT_EQ(table.contested, 0);
    int across = 0, held = 0;
    for (size_t i = 0; i < table.size(); ++i) {
      const Vector2d uv = CentreUv(table, table.pixel[i]);
      const bool right = table.chart_at[table.pixel[i]] == 1;
      Vector3d expected(right ? 0.5 + (0.9 - uv.y()) / 0.5 : (uv.x() - 0.05) / 0.7,
                        right ? (uv.x() - 0.5) / 0.4 : (uv.y() - 0.1) / 0.8, 0);
      const bool beyond_sheet = expected.head<2>().minCoeff() < 0 || expected.head<2>().maxCoeff() > 1;
      const Vector3d found = PointOf(body, table.face[i], table.barycentric[i]);
      if (beyond_sheet) {  // where the mesh ends the boundary is held
        ASSERT_TRUE(table.in_gutter[i]);
        EXPECT_LT((found - expected).norm(), 0.15);
        ++held;
        continue;
      }
      ASSERT_LT((found - expected).norm(), 1e-5) << "texel " << table.pixel[i] % size << " " << table.pixel[i] / size;
      across += table.in_gutter[i];
    }
    EXPECT_GT(across, 200);
    EXPECT_GT(held, 200);
  }
}

/// Vector of a baked unit-normal map at uv, bilinear over the texels of one chart.
Vector3d Lookup(const UvTexelTable& table, const std::vector<Vector3d>& map, const Vector2d& uv) {
  const double x = uv.x() * table.width - 0.5, y = (1 - uv.y()) * table.height - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  Vector3d sum = Vector3d::Zero();
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const double w = (i ? x - x0 : 1 - x + x0) * (j ? y - y0 : 1 - y + y0);
      sum += w * map[(y0 + j) * table.width + x0 + i];
    }
  }
  return sum;
}

TEST(UvTexels, MakeSeamsThatLookupsDoNotSee) {
  const BodyModel body(SphereOfOctants(5));
  const UvCharts charts = FindUvCharts(body);
  double rms[3] = {}, worst[3] = {};
  for (const int kind : {0, 1, 2}) {  // no gutter, nearest texel repeated, the surface across
    const UvTexelTable table = BuildUvTexelTable(body, {.gutter = kind == 2 ? 1 : 0});
    std::vector<Vector3d> map(128 * 128, Vector3d::Zero());
    for (size_t i = 0; i < table.size(); ++i) {
      map[table.pixel[i]] = PointOf(body, table.face[i], table.barycentric[i]).normalized();
    }
    if (kind == 1) {
      const std::vector<Vector3d> inside = map;
      for (int p = 129; p < 128 * 127 - 1; ++p) {
        for (const int step : {-1, 1, -128, 128, -129, 129, -127, 127}) {
          if (map[p].isZero() && !inside[p + step].isZero()) map[p] = inside[p + step];
        }
      }
    }
    double sum = 0;
    int count = 0;
    for (int h = 0; h < 3 * body.num_faces(); ++h) {
      if (!charts.is_seam[h]) continue;
      for (double along : {0.1, 0.3, 0.5, 0.7, 0.9}) {
        for (double inward : {0.001, 0.3}) {  // of a face that is about a texel high
          Vector3d b = Vector3d::Zero();
          b[h % 3] = (1 - along) * (1 - inward);
          b[(h + 1) % 3] = along * (1 - inward);
          b[(h + 2) % 3] = inward;
          const Vector3d exact = PointOf(body, h / 3, b.cast<float>()).normalized();
          const Vector3d found = Lookup(table, map, UvOf(body, h / 3, b));
          const double angle = found.isZero() ? M_PI : std::atan2(found.cross(exact).norm(), found.dot(exact));
          sum += (found - exact).squaredNorm();
          worst[kind] = std::max(worst[kind], angle / kDegree);
          ++count;
        }
      }
    }
    rms[kind] = std::sqrt(sum / count);
  }
  RecordProperty("rms_none_dilated_across",
                 std::to_string(rms[0]) + " " + std::to_string(rms[1]) + " " + std::to_string(rms[2]));
  EXPECT_LT(worst[2], 0.3);
  EXPECT_LT(rms[2], 0.2 * rms[1]);
  EXPECT_GT(rms[0], 0.1);
}

TEST(UvTexels, CountWhatIsOddAboutAMap) {
  const UvTexelTable clean = BuildUvTexelTable(BodyModel(SphereOfOctants(2)));
  EXPECT_EQ(clean.overlapping + clean.contested + clean.faces_outside + clean.faces_without_area, 0);
  // Charts that touch: the two halves of a cell's boundary belong to two charts.
  BodyModelData touching = SphereOfOctants(2, 0.0);
  const UvTexelTable close = BuildUvTexelTable(BodyModel(touching));
  EXPECT_GT(close.contested, 30);
  EXPECT_EQ(close.overlapping, 0);
  // One octant on top of another: the lowest face wins.
  BodyModelData overlapping = SphereOfOctants(2);
  const BodyModelData apart = overlapping;
  overlapping.ft.bottomRows(16) = overlapping.ft.topRows(16);
  const UvTexelTable over = BuildUvTexelTable(BodyModel(overlapping), {.gutter = 0});
  EXPECT_GT(over.overlapping, 100);
  for (const int face : over.face) EXPECT_LT(face, overlapping.faces.rows() - 16);
  // A chart shifted half out of the map, a face squeezed to a line.
  BodyModelData outside = apart;
  outside.vt.col(0).array() -= 0.05F;
  const UvTexelTable cut = BuildUvTexelTable(BodyModel(outside));
  EXPECT_GT(cut.faces_outside, 4);
  EXPECT_LT(cut.num_inside, clean.num_inside);
  for (const int chart : {0, 4}) EXPECT_GT(std::count(cut.chart_at.begin(), cut.chart_at.end(), chart), 10);
  BodyModelData squeezed = apart;
  squeezed.ft.row(3).setConstant(squeezed.ft(3, 0));
  EXPECT_EQ(BuildUvTexelTable(BodyModel(squeezed)).faces_without_area, 1);
}

template <typename Action>
std::string MessageOf(const Action& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(UvTexels, RefuseWhatTheyCannotUse) {
  BodyModelData data = SphereOfOctants(1);
  const BodyModelData good = data;
  data.vt.resize(0, 2);
  data.ft.resize(0, 3);
  EXPECT_THAT(MessageOf([&] { BuildUvTexelTable(BodyModel(data)); }), HasSubstr("has no UV map"));
  data = good;
  data.vt.array() += 3;
  EXPECT_THAT(MessageOf([&] { BuildUvTexelTable(BodyModel(data)); }), HasSubstr("outside [0,1]"));
  const BodyModel body(good);
  for (const UvTexelOptions& options : {UvTexelOptions{.width = 0},
                                        {.height = -3},
                                        {.width = 16385},
                                        {.width = 16384, .height = 16384},
                                        {.gutter = -1},
                                        {.gutter = 65}}) {
    EXPECT_THAT(MessageOf([&] { BuildUvTexelTable(body, options); }), HasSubstr("UV texels"));
  }
}

TEST(UvTexels, OfAMapOfOneTexel) {
  BodyModelData data = SphereOfOctants(1);
  data.vt.array() = (data.vt.array() - 0.3F) * 40 + 0.5F;  // one face covers the centre
  const UvTexelTable table = BuildUvTexelTable(BodyModel(data), {.width = 1, .height = 1});
  EXPECT_EQ(table.size(), 1U);
}

}  // namespace
}  // namespace bodyloom::uv_texels_test
