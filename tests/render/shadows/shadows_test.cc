// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <vector>

#include "render/shadows/shadow_map.h"

namespace bodyloom::shadows_test {
namespace {

using Eigen::Vector3d;

struct Mesh {
  MatrixX3d vertices;
  MatrixX3i faces;
  MatrixX3f normals;
};

/// Parallelograms of n × n cells each, from a corner along two sides; their normals are side × other.
struct Sheet {
  Vector3d corner, side, other;
};

Mesh OfSheets(const std::vector<Sheet>& sheets, int n) {
  const int each = (n + 1) * (n + 1), count = static_cast<int>(sheets.size());
  Mesh mesh{MatrixX3d(count * each, 3), MatrixX3i(2 * count * n * n, 3), MatrixX3f(count * each, 3)};
  int face = 0;
  for (int s = 0; s < count; ++s) {
    const Sheet& sheet = sheets[s];
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        const int v = s * each + i * (n + 1) + j;
        mesh.vertices.row(v) = (sheet.corner + sheet.side * i / n + sheet.other * j / n).transpose();
        mesh.normals.row(v) = sheet.side.cross(sheet.other).normalized().transpose().cast<float>();
        if (i == n || j == n) continue;
        mesh.faces.row(face++) << v, v + n + 1, v + n + 2;
        mesh.faces.row(face++) << v, v + n + 2, v + 1;
      }
    }
  }
  return mesh;
}

/// A floor of 4 m, and a plate of 1 m above its middle.
const std::vector<Sheet> kFloorAndPlate = {{{-2, 0, 2}, {4, 0, 0}, {0, 0, -4}},
                                           {{-0.5, 1, 0.5}, {1, 0, 0}, {0, 0, -1}}};

TEST(ShadowMap, AShadowLiesWhereItsRaysEnd) {
  const Mesh mesh = OfSheets(kFloorAndPlate, 4);
  ShadowMap map;
  for (const double slope : {0.0, 0.5, -1.2}) {  // the light moves the shadow by as much a metre of height
    map.Render(mesh.vertices, mesh.faces, Vector3d(slope, 1, 0).normalized(), 512);
    for (double x = -1.95; x < 1.96; x += 0.1) {
      const bool inside = std::abs(x + slope) < 0.5;
      if (std::abs(std::abs(x + slope) - 0.5) < 3 * map.metres_a_pixel()) continue;
      EXPECT_EQ(map.Reaches({x, 0.01, 0.2}), !inside) << slope << ", " << x;
      EXPECT_TRUE(map.Reaches({x, 1.02, 0.2}));   // above the plate
      EXPECT_TRUE(map.Reaches({x, 0.01, -0.8}));  // beside its shadow
    }
  }
}

TEST(ShadowMap, FacesDoNotShadeThemselves) {
  const Mesh mesh = OfSheets({kFloorAndPlate[0]}, 3);
  ShadowMap map;
  for (const double slope : {0.0, 1.0, 1.7}) {
    map.Render(mesh.vertices, mesh.faces, Vector3d(slope, 1, 0.3).normalized(), 256);
    for (double x = -1.9; x < 1.9; x += 0.013) EXPECT_TRUE(map.Reaches({x, 1e-3, 0.7 * x})) << slope << ", " << x;
  }
}

TEST(ShadowMap, AnEdgeIsAsWideAsTheLightIsSoft) {
  const Mesh mesh = OfSheets(kFloorAndPlate, 4);
  ShadowMap map;
  map.Render(mesh.vertices, mesh.faces, Vector3d::UnitY(), 1024);
  constexpr double kSoftness = 0.2;
  for (double x = 0.2; x < 0.8; x += 0.02) {  // the plate ends at 0.5
    const double expected = std::clamp(0.5 + (x - 0.5) / (2 * kSoftness), 0.0, 1.0);
    EXPECT_NEAR(map.ShareReaching({x, 0.01, 0}, kSoftness), expected, 0.13) << x;  // four steps
  }
  EXPECT_EQ(map.ShareReaching({0.49, 0.01, 0}, 0), 0);
  EXPECT_EQ(map.ShareReaching({0.52, 0.01, 0}, 0), 1);
}

TEST(ShadowMap, WhatIsNoLightIsRefused) {
  const Mesh mesh = OfSheets(kFloorAndPlate, 1);
  ShadowMap map;
  EXPECT_THROW(map.Render(mesh.vertices, mesh.faces, {0, 2, 0}, 64), std::invalid_argument);
  EXPECT_THROW(map.Render(mesh.vertices, mesh.faces, {NAN, 0, 1}, 64), std::invalid_argument);
  EXPECT_THROW(map.Render(MatrixX3d(0, 3), MatrixX3i(0, 3), Vector3d::UnitY(), 64), std::invalid_argument);
  EXPECT_THROW(map.Render(mesh.vertices, mesh.faces, Vector3d::UnitY(), 4), std::invalid_argument);
}

TEST(AmbientOcclusionTest, BeforeAWallItIsTheKnownShare) {
  // An endless wall of height h at distance d takes ½ (1 − d/√(d² + h²)) of what a floor sees; here it is 8 m wide.
  constexpr double kHeight = 1;
  const Mesh mesh = OfSheets({{{0, 0, 4}, {2, 0, 0}, {0, 0, -8}}, {{0, 0, -4}, {0, kHeight, 0}, {0, 0, 8}}}, 40);
  AmbientOcclusion open;
  const std::vector<float>& ambient_occlusion = open.Compute(mesh.vertices, mesh.normals, mesh.faces);
  double sum = 0;
  int count = 0;
  for (Eigen::Index v = 0; v < mesh.vertices.rows() / 2; ++v) {
    const double d = mesh.vertices(v, 0);
    if (d < 0.1 || std::abs(mesh.vertices(v, 2)) > 0.5) continue;
    const double error = ambient_occlusion[v] - (1 - 0.5 * (1 - d / std::hypot(d, kHeight)));
    EXPECT_LT(std::abs(error), 0.08) << d;  // 24 directions a side
    sum += error;
    ++count;
  }
  ASSERT_GT(count, 100);
  EXPECT_LT(std::abs(sum / count), 0.02);
}

TEST(AmbientOcclusionTest, WhatIsConvexIsOpen) {
  Mesh mesh;  // a box, seen from outside, corners shared by nothing
  mesh = OfSheets({{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                   {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                   {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
                   {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}},
                   {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}},
                  6);
  AmbientOcclusion open;
  for (const float value : open.Compute(mesh.vertices, mesh.normals, mesh.faces)) EXPECT_EQ(value, 1);
  mesh.normals *= -1;  // from inside nothing is
  const std::vector<float>& inside = open.Compute(mesh.vertices, mesh.normals, mesh.faces);
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v) {
    const Vector3d from_middle = (mesh.vertices.row(v).transpose() - Vector3d::Constant(0.5)).cwiseAbs();
    const bool at_edge = (from_middle.array() > 0.45).count() > 1;  // what is lifted off one face lies in another
    if (!at_edge) {
      EXPECT_EQ(inside[v], 0);
    }
  }
  mesh.normals.setZero();
  EXPECT_EQ(open.Compute(mesh.vertices, mesh.normals, mesh.faces)[7], 1);
  EXPECT_THROW((void)open.Compute(mesh.vertices, mesh.normals.topRows(3), mesh.faces), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::shadows_test
