// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/capped_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include "tests/support/meshes.h"

namespace bodyloom::capped_mesh_test {
namespace {

using Eigen::Vector3d;

std::vector<int> AllFaces(const TestMesh& mesh) {
  std::vector<int> faces(mesh.faces.rows());
  std::iota(faces.begin(), faces.end(), 0);
  return faces;
}

CappedMesh Placed(const TestMesh& mesh, const std::vector<int>& faces) {
  CappedMesh part(mesh.faces, faces);
  part.Place(mesh.vertices * GenericRotation().transpose());
  return part;
}

/// A part in the mesh's own frame.
struct Asked {
  CappedMesh part;
  bool Contains(const Vector3d& p) { return part.Contains(GenericRotation() * p); }
  double Distance(const Vector3d& p) { return part.Distance(GenericRotation() * p); }
};

/// The cube [−1, 1]³ with faces of two triangles a side, aligned with the axes.
TestMesh Cube() {
  TestMesh cube{MatrixX3d(8, 3), MatrixX3i(12, 3)};
  for (int i = 0; i < 8; ++i) cube.vertices.row(i) << (i & 1 ? 1 : -1), (i & 2 ? 1 : -1), (i & 4 ? 1 : -1);
  cube.faces << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7,
      5;
  return cube;
}

TEST(CappedMesh, ACubeHoldsWhatIsInIt) {
  Asked cube{Placed(Cube(), AllFaces(Cube()))};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p{any(random), any(random), any(random)};
    const double largest = p.cwiseAbs().maxCoeff();
    EXPECT_EQ(cube.Contains(p), largest < 1) << p.transpose();
    inside += largest < 1 ? 1 : 0;
    const Vector3d beyond = (p.cwiseAbs().array() - 1).max(0.0).matrix();
    EXPECT_NEAR(cube.Distance(p), largest < 1 ? 1 - largest : beyond.norm(), 1e-12);
  }
  EXPECT_GT(inside, 400);
  for (const double x : {-0.5, 0.0, 0.5}) EXPECT_TRUE(cube.Contains({x, 0, 0})) << "lined up with edges and corners";
}

/// Rays exactly through an edge, in the frame of the rays itself, cross one of its two faces.
TEST(CappedMesh, ARayThroughAnEdgeCrossesOneFace) {
  TestMesh pyramid{MatrixX3d(9, 3), MatrixX3i(10, 3)};
  pyramid.vertices << -1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0, 0.3, -0.2, 1,  // and a tetrahedron far below, which makes
      5, 5, -2, 6, 5, -2, 5, 6, -2, 5, 5, -1.5;                              // the box reach there
  pyramid.faces << 0, 2, 3, 0, 3, 1, 0, 1, 4, 1, 3, 4, 3, 2, 4, 2, 0, 4,     // the base is split along x = y
      5, 7, 6, 5, 6, 8, 6, 7, 8, 7, 5, 8;
  for (const bool other_way : {false, true}) {
    if (other_way) pyramid.faces.topRows<2>() << 3, 0, 2, 1, 0, 3;
    CappedMesh part(pyramid.faces, AllFaces(pyramid));
    part.Place(pyramid.vertices);
    for (double t = -0.875; t < 0.9; t += 0.125) {
      EXPECT_FALSE(part.Contains({t, t, -0.5})) << t;
      EXPECT_TRUE(part.Contains({t, t, 0x1p-40})) << t;
    }
  }
}

/// An open part is closed by a fan: half a sphere holds half a ball.
TEST(CappedMesh, HolesAreClosedByFans) {
  const TestMesh sphere = UnitSphere(4);
  std::vector<int> upper, middle;
  for (int f = 0; f < sphere.faces.rows(); ++f) {
    const double y = (sphere.vertices(sphere.faces(f, 0), 1) + sphere.vertices(sphere.faces(f, 1), 1) +
                      sphere.vertices(sphere.faces(f, 2), 1)) /
                     3;
    if (y > 0) upper.push_back(f);
    if (std::abs(y) < 0.5) middle.push_back(f);
  }
  Asked half{Placed(sphere, upper)}, barrel{Placed(sphere, middle)};
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1.1, 1.1);
  int tested = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p{any(random), any(random), any(random)};
    if (std::abs(p.norm() - 1) < 0.01 || std::abs(p.y()) < 0.07 || std::abs(std::abs(p.y()) - 0.5) < 0.07) continue;
    ++tested;
    EXPECT_EQ(half.Contains(p), p.norm() < 1 && p.y() > 0) << p.transpose();
    EXPECT_EQ(barrel.Contains(p), p.norm() < 1 && std::abs(p.y()) < 0.5) << p.transpose();
  }
  EXPECT_GT(tested, 1000);
  // Fans are no skin: from the middle of the ball the nearest skin is the sphere.
  EXPECT_NEAR(half.Distance({0, 0.2, 0}), 0.8, 5e-3);
  EXPECT_NEAR(half.Distance({0, -0.2, 0}), std::hypot(1.0, 0.2), 0.05);
}

/// The winding number as a sum of solid angles (Van Oosterom and Strackee 1983), which no ray enters.
double SolidAngles(const TestMesh& mesh, const Vector3d& p) {
  double sum = 0;
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    const auto corner = [&](int c) -> Vector3d { return mesh.vertices.row(mesh.faces(f, c)).transpose() - p; };
    const Vector3d a = corner(0), b = corner(1), c = corner(2);
    const double l = a.norm(), m = b.norm(), n = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), l * m * n + a.dot(b) * n + b.dot(c) * l + c.dot(a) * m);
  }
  return sum / (4 * std::numbers::pi);
}

/// Crumpled spheres that cross themselves: where the surface is wound twice or backwards the number is still right.
TEST(CappedMesh, AgreesWithSolidAnglesAlsoWhereTheSurfaceCrossesItself) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.35);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  int inside = 0, backwards = 0;
  for (int round = 0; round < 10; ++round) {
    TestMesh mesh = UnitSphere(2);
    for (Eigen::Index i = 0; i < mesh.vertices.size(); ++i) mesh.vertices.data()[i] += noise(random);
    Asked part{Placed(mesh, AllFaces(mesh))};
    for (int i = 0; i < 200; ++i) {
      const Vector3d p{any(random), any(random), any(random)};
      const double winding = SolidAngles(mesh, p);
      ASSERT_NEAR(winding, std::round(winding), 1e-9);
      EXPECT_EQ(part.Contains(p), std::lround(winding) != 0) << "round " << round << ", winding " << winding;
      inside += std::lround(winding) > 0 ? 1 : 0;
      backwards += std::lround(winding) < 0 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(backwards, 5);
}

TEST(CappedMesh, DistanceIsThatOfEveryFaceInTurn) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-2, 2);
  TestMesh mesh = UnitSphere(3);
  mesh.vertices.col(1) *= 3;  // long faces and short ones
  Asked part{Placed(mesh, AllFaces(mesh))};
  for (int i = 0; i < 300; ++i) {
    const Vector3d p{any(random), any(random), any(random)};
    double best = std::numeric_limits<double>::infinity();
    for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
      const auto corner = [&](int c) -> Vector3d { return mesh.vertices.row(mesh.faces(f, c)).transpose(); };
      best = std::min(best, SquaredDistanceToTriangle(p, corner(0), corner(1), corner(2)));
    }
    EXPECT_NEAR(part.Distance(p), std::sqrt(best), 1e-12);
  }
}

TEST(CappedMesh, DistanceToATriangleIsTheSmallestOverIt) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 50; ++i) {
    Vector3d point[4];
    for (Vector3d& x : point) x = Vector3d{any(random), any(random), any(random)};
    if (i % 10 == 0) point[3] = point[2] + 0.3 * (point[2] - point[1]);  // no area
    double best = std::numeric_limits<double>::infinity();
    constexpr int kSteps = 200;
    for (int u = 0; u <= kSteps; ++u) {
      for (int v = 0; u + v <= kSteps; ++v) {
        const Vector3d on =
            point[1] + double(u) / kSteps * (point[2] - point[1]) + double(v) / kSteps * (point[3] - point[1]);
        best = std::min(best, (point[0] - on).norm());
      }
    }
    const double distance = std::sqrt(SquaredDistanceToTriangle(point[0], point[1], point[2], point[3]));
    EXPECT_LE(distance, best + 1e-12);
    EXPECT_NEAR(distance, best, 0.02);
  }
  EXPECT_EQ(SquaredDistanceToTriangle({0.2, 0.2, -3}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 9);
  EXPECT_EQ(SquaredDistanceToTriangle({-3, -4, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 25);
}

TEST(CappedMesh, NothingHoldsNothing) {
  CappedMesh part(Cube().faces, {});
  part.Place(Cube().vertices);
  EXPECT_TRUE(part.empty());
  EXPECT_FALSE(part.Contains({0, 0, 0}));
  EXPECT_EQ(part.Distance({0, 0, 0}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace bodyloom::capped_mesh_test
