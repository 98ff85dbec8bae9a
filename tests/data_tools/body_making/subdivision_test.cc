// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/subdivision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "tests/data_tools/body_making/openmesh_catmull_clark.h"

namespace bodyloom::subdivision_test {
namespace {

QuadMesh Cube() {
  QuadMesh cube;
  cube.vertices.resize(8, 3);
  for (int i = 0; i < 8; ++i) cube.vertices.row(i) << (i & 1 ? 1 : -1), (i & 2 ? 1 : -1), (i & 4 ? 1 : -1);
  cube.quads = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return cube;
}

/// A torus of `around` × `along` quads with shaken vertices: all valences 4, genus 1.
QuadMesh ShakenTorus(int around, int along) {
  QuadMesh torus;
  torus.vertices.resize(around * along, 3);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shake(-0.05, 0.05);
  const auto index = [&](int i, int j) { return (i % around) * along + j % along; };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < along; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / along;
      torus.vertices.row(index(i, j)) << (1 + 0.4 * std::cos(b)) * std::cos(a) + shake(random),
          (1 + 0.4 * std::cos(b)) * std::sin(a) + shake(random), 0.4 * std::sin(b) + shake(random);
      torus.quads.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  return torus;
}

QuadMesh Subdivide(const QuadMesh& mesh, int levels) {
  QuadMesh fine = mesh;
  for (int level = 0; level < levels; ++level) {
    const SubdivisionLevel finer = SubdivideCatmullClark(static_cast<int>(fine.vertices.rows()), fine.quads);
    fine = {finer.fine_from_coarse * fine.vertices, finer.quads};
  }
  return fine;
}

TEST(Subdivision, CubeByHand) {
  const QuadMesh cube = Cube();
  const SubdivisionLevel level = SubdivideCatmullClark(8, cube.quads);
  const MatrixX3d fine = level.fine_from_coarse * cube.vertices;
  ASSERT_EQ(fine.rows(), 8 + 6 + 12);
  ASSERT_EQ(level.quads.size(), 24u);
  // Valence 3: (mean of face points 1/3 + 2 · mean of midpoints 2/3 + 0) / 3 = 5/9 of the corner.
  EXPECT_LT((fine.topRows(8) - 5.0 / 9 * cube.vertices).cwiseAbs().maxCoeff(), 1e-15);
  // Face points: centres. Edge points: (1 + 1 + 1 + 0)/4 outward in both directions that the edge has.
  for (int f = 0; f < 6; ++f) EXPECT_NEAR(fine.row(8 + f).cwiseAbs().sum(), 1, 1e-15);
  for (int e = 0; e < 12; ++e) {
    const Eigen::RowVector3d midpoint =
        (cube.vertices.row(level.edges[e][0]) + cube.vertices.row(level.edges[e][1])) / 2;
    EXPECT_LT((fine.row(14 + e) - 0.75 * midpoint).norm(), 1e-15) << "edge " << e;
  }
}

TEST(Subdivision, IndexOrder) {
  const QuadMesh cube = Cube();
  const SubdivisionLevel level = SubdivideCatmullClark(8, cube.quads);
  // First quad (0,2,3,1): its edges are the first four, in the order 01, 12, 23, 30.
  EXPECT_EQ(level.edges[0], (Edge{0, 2}));
  EXPECT_EQ(level.edges[1], (Edge{2, 3}));
  EXPECT_EQ(level.edges[2], (Edge{3, 1}));
  EXPECT_EQ(level.edges[3], (Edge{1, 0}));
  EXPECT_EQ(level.quads[0], (Quad{0, 14, 8, 17}));
  EXPECT_EQ(level.quads[1], (Quad{2, 15, 8, 14}));
  EXPECT_EQ(level.quads[2], (Quad{3, 16, 8, 15}));
  EXPECT_EQ(level.quads[3], (Quad{1, 17, 8, 16}));
  for (size_t q = 0; q < level.quads.size(); ++q) EXPECT_EQ(level.quads[q][0], cube.quads[q / 4][q % 4]);
}

TEST(Subdivision, RowsSumToOne) {
  const QuadMesh torus = ShakenTorus(5, 4);
  const SubdivisionLevel level = SubdivideCatmullClark(20, torus.quads);
  const Eigen::VectorXd sums = level.fine_from_coarse * Eigen::VectorXd::Ones(20);
  EXPECT_LT((sums.array() - 1).abs().maxCoeff(), 1e-14);
}

TEST(Subdivision, EqualsOpenMesh) {
  for (const QuadMesh& mesh : {Cube(), ShakenTorus(7, 5), Subdivide(Cube(), 1)}) {
    for (int levels = 1; levels <= 3; ++levels) {
      const MeshAgreement agreement =
          CompareByGeometry(Subdivide(mesh, levels), SubdivideByOpenMesh(mesh, levels), 1e-9);
      EXPECT_TRUE(agreement.Equal()) << agreement.BriefReport();
      EXPECT_LT(agreement.max_vertex_distance_m, 1e-14);
    }
  }
}

TEST(Subdivision, ComparisonSeesDifferences) {
  const QuadMesh mesh = Subdivide(ShakenTorus(7, 5), 1);
  QuadMesh moved = mesh;
  moved.vertices(3, 1) += 1e-4;
  const MeshAgreement far = CompareByGeometry(mesh, moved, 1e-6);
  EXPECT_EQ(far.unmatched_vertices, 1);
  EXPECT_EQ(far.unmatched_quads, 8);  // four on each side
  EXPECT_TRUE(CompareByGeometry(mesh, moved, 1e-3).Equal());
  EXPECT_NEAR(CompareByGeometry(mesh, moved, 1e-3).max_vertex_distance_m, 1e-4, 1e-12);

  QuadMesh turned = mesh;
  std::swap(turned.quads[5][1], turned.quads[5][3]);  // reversed orientation
  EXPECT_EQ(CompareByGeometry(mesh, turned, 1e-6).unmatched_quads, 2);
  QuadMesh shifted = mesh;  // the same cycle begun elsewhere is the same quad
  std::rotate(shifted.quads[5].begin(), shifted.quads[5].begin() + 1, shifted.quads[5].end());
  EXPECT_TRUE(CompareByGeometry(mesh, shifted, 1e-6).Equal());
  QuadMesh fewer = mesh;
  fewer.quads.pop_back();
  EXPECT_EQ(CompareByGeometry(mesh, fewer, 1e-6).unmatched_quads, 1);
  EXPECT_EQ(CompareByGeometry(fewer, mesh, 1e-6).unmatched_quads, 1);
}

TEST(Subdivision, MirrorMap) {
  const QuadMesh cube = Cube();
  std::vector<int> mirror(8);
  for (int i = 0; i < 8; ++i) mirror[i] = i ^ 1;  // x → −x
  std::vector<Quad> quads = cube.quads;
  MatrixX3d vertices = cube.vertices;
  for (int round = 0; round < 2; ++round) {
    const SubdivisionLevel level = SubdivideCatmullClark(static_cast<int>(vertices.rows()), quads);
    mirror = MirrorOfSubdivision(mirror, quads, level);
    vertices = level.fine_from_coarse * vertices;
    quads = level.quads;
    ASSERT_EQ(static_cast<Eigen::Index>(mirror.size()), vertices.rows());
    int on_plane = 0;
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      EXPECT_EQ(mirror[mirror[v]], v);
      EXPECT_NEAR(vertices(mirror[v], 0), -vertices(v, 0), 1e-15);
      EXPECT_NEAR(vertices(mirror[v], 1), vertices(v, 1), 1e-15);
      EXPECT_NEAR(vertices(mirror[v], 2), vertices(v, 2), 1e-15);
      on_plane += mirror[v] == v;
    }
    EXPECT_EQ(on_plane, round == 0 ? 8 : 16);
  }
}

TEST(Subdivision, MirrorMapRefusesAsymmetricMesh) {
  const QuadMesh cube = Cube();
  const SubdivisionLevel level = SubdivideCatmullClark(8, cube.quads);
  EXPECT_THROW(MirrorOfSubdivision({1, 0, 3, 2, 5, 4, 6, 7}, cube.quads, level), std::invalid_argument);
  EXPECT_THROW(MirrorOfSubdivision({1, 0, 3, 2}, cube.quads, level), std::invalid_argument);
}

/// Two cubes that touch in a corner: the two fans of that vertex are no manifold.
TEST(Subdivision, RefusesQuadsThatMeetInAVertexAlone) {
  const QuadMesh cube = Cube();
  std::vector<Quad> quads = cube.quads;
  for (Quad quad : cube.quads) {
    for (int& v : quad) v = v == 0 ? 7 : v + 8;
    quads.push_back(quad);
  }
  // Vertex 8 would be in no quad: close the gap.
  for (Quad& quad : quads) {
    for (int& v : quad) v -= v > 8 ? 1 : 0;
  }
  for (int order = 0; order < 3; ++order) {
    EXPECT_THROW(SubdivideCatmullClark(15, quads), std::invalid_argument) << "order " << order;
    std::shuffle(quads.begin(), quads.end(), std::mt19937(order));
  }
}

TEST(Subdivision, RefusesMeshesThatAreNotClosed) {
  QuadMesh open = Cube();
  open.quads.pop_back();
  EXPECT_THROW(SubdivideCatmullClark(8, open.quads), std::invalid_argument);
  QuadMesh twisted = Cube();
  std::swap(twisted.quads[0][1], twisted.quads[0][3]);
  EXPECT_THROW(SubdivideCatmullClark(8, twisted.quads), std::invalid_argument);
  QuadMesh doubled = Cube();
  doubled.quads.push_back(doubled.quads[0]);
  EXPECT_THROW(SubdivideCatmullClark(8, doubled.quads), std::invalid_argument);
  QuadMesh wild = Cube();
  wild.quads[0][0] = 8;
  EXPECT_THROW(SubdivideCatmullClark(8, wild.quads), std::invalid_argument);
  wild.quads[0][0] = -1;
  EXPECT_THROW(SubdivideCatmullClark(8, wild.quads), std::invalid_argument);
  EXPECT_THROW(SubdivideCatmullClark(9, Cube().quads), std::invalid_argument);  // a vertex without edges
}

TEST(Subdivision, TrianglesOfQuads) {
  const MatrixX3i triangles = TrianglesOfQuads({{4, 5, 6, 7}});
  ASSERT_EQ(triangles.rows(), 2);
  EXPECT_EQ(triangles.row(0), Eigen::RowVector3i(4, 5, 6));
  EXPECT_EQ(triangles.row(1), Eigen::RowVector3i(4, 6, 7));
}

}  // namespace
}  // namespace bodyloom::subdivision_test
