// SPDX-License-Identifier: Apache-2.0
#include "geometry/mesh/mesh_check.h"

#include <gtest/gtest.h>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/support/meshes.h"

namespace bodyloom::mesh_check_test {
namespace {

TestMesh MeshOf(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3i>& faces) {
  TestMesh mesh{MatrixX3d(points.size(), 3), MatrixX3i(faces.size(), 3)};
  for (size_t i = 0; i < points.size(); ++i) mesh.vertices.row(i) = points[i].transpose();
  for (size_t i = 0; i < faces.size(); ++i) mesh.faces.row(i) = faces[i].transpose();
  return mesh;
}

/// Corners (0,0,0), (1,0,0), (0,1,0), (0,0,1), outward.
TestMesh Tetrahedron() {
  return MeshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

void Append(const TestMesh& more, TestMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.rows());
  TestMesh both{MatrixX3d(first + more.vertices.rows(), 3), MatrixX3i(mesh->faces.rows() + more.faces.rows(), 3)};
  both.vertices << mesh->vertices, more.vertices;
  both.faces << mesh->faces, (more.faces.array() + first).matrix();
  *mesh = both;
}

void AddFaces(const std::vector<Eigen::Vector3i>& faces, TestMesh* mesh) {
  const Eigen::Index before = mesh->faces.rows();
  mesh->faces.conservativeResize(before + static_cast<Eigen::Index>(faces.size()), 3);
  for (size_t i = 0; i < faces.size(); ++i)
    mesh->faces.row(before + static_cast<Eigen::Index>(i)) = faces[i].transpose();
}

void Turn(int face, TestMesh* mesh) { std::swap(mesh->faces(face, 0), mesh->faces(face, 1)); }

CheckMeshResult Check(const TestMesh& mesh) { return CheckMesh(mesh.vertices, mesh.faces); }

TEST(MeshCheck, FindsNothingOnASphere) {
  const TestMesh sphere = UnitSphere(4);
  const CheckMeshResult result = Check(sphere);
  EXPECT_TRUE(result.IsClean());
  ASSERT_EQ(result.components.size(), 1u);
  EXPECT_TRUE(result.components[0].is_closed);
  EXPECT_TRUE(result.components[0].is_orientable);
  EXPECT_EQ(result.components[0].num_faces, sphere.faces.rows());
  EXPECT_NEAR(result.components[0].volume_m3, 4 * std::numbers::pi / 3, 0.02);
  EXPECT_NEAR(Check(Tetrahedron()).components[0].volume_m3, 1.0 / 6, 1e-15);
}

TEST(MeshCheck, VolumeDoesNotDependOnWhereTheMeshIs) {
  TestMesh far = Tetrahedron();
  far.vertices.rowwise() += Eigen::RowVector3d(1000003, -1000001, 500009);  // exact in double
  EXPECT_NEAR(Check(far).components[0].volume_m3, 1.0 / 6, 1e-12);
}

TEST(MeshCheck, AHoleIsALoopOfItsEdges) {
  TestMesh mesh = UnitSphere(2);
  mesh.faces = MatrixX3i(mesh.faces.bottomRows(mesh.faces.rows() - 1));
  const CheckMeshResult result = Check(mesh);
  EXPECT_FALSE(result.IsClean());
  EXPECT_EQ(result.boundary_edges, 3);
  ASSERT_EQ(result.boundary_loops.size(), 1u);
  EXPECT_EQ(result.boundary_loops[0].size(), 3u);
  EXPECT_FALSE(result.components[0].is_closed);
  EXPECT_TRUE(result.turned_faces.empty()) << "a hole does not turn the rest";
  // The fan over a triangle is that triangle: the volume is the whole sphere's.
  EXPECT_NEAR(result.components[0].volume_m3, Check(UnitSphere(2)).components[0].volume_m3, 1e-12);
}

TEST(MeshCheck, TwoHolesAreTwoLoops) {
  // A ring of six sides without its ends.
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> faces;
  for (int k = 0; k < 6; ++k) {
    const double a = k * std::numbers::pi / 3;
    points.insert(points.end(), {{std::cos(a), std::sin(a), 0}, {std::cos(a), std::sin(a), 1}});
    const int p = 2 * k, q = (2 * k + 2) % 12;
    faces.insert(faces.end(), {{p, q, q + 1}, {p, q + 1, p + 1}});
  }
  const CheckMeshResult result = Check(MeshOf(points, faces));
  EXPECT_EQ(result.boundary_edges, 12);
  ASSERT_EQ(result.boundary_loops.size(), 2u);
  EXPECT_EQ(result.boundary_loops[0].size(), 6u);
  EXPECT_EQ(result.boundary_loops[1].size(), 6u);
  EXPECT_NEAR(result.components[0].volume_m3, 1.5 * std::sqrt(3.0), 1e-12) << "a prism once its ends are closed";
  EXPECT_TRUE(result.turned_faces.empty());
}

TEST(MeshCheck, ATurnedFaceIsNamed) {
  TestMesh mesh = UnitSphere(2);
  Turn(17, &mesh);
  Turn(200, &mesh);
  const CheckMeshResult result = Check(mesh);
  EXPECT_EQ(result.turned_faces, (std::vector<int>{17, 200}));
  EXPECT_EQ(result.inconsistent_edges, 6);
  EXPECT_EQ(result.components[0].turned_faces, 2);
  EXPECT_TRUE(result.components[0].is_orientable);
}

TEST(MeshCheck, TheFirstFaceMayBeTheTurnedOne) {
  TestMesh mesh = UnitSphere(2);
  Turn(0, &mesh);
  EXPECT_EQ(Check(mesh).turned_faces, std::vector<int>{0});
}

TEST(MeshCheck, AnInsideOutSurfaceIsTurnedAsAWhole) {
  TestMesh mesh = UnitSphere(1);
  for (int f = 0; f < mesh.faces.rows(); ++f) Turn(f, &mesh);
  const CheckMeshResult result = Check(mesh);
  EXPECT_EQ(result.inconsistent_edges, 0);
  EXPECT_EQ(static_cast<Eigen::Index>(result.turned_faces.size()), mesh.faces.rows());
  EXPECT_FALSE(result.IsClean());
}

TEST(MeshCheck, EveryComponentIsOrientedByItself) {
  TestMesh mesh = UnitSphere(1), small = UnitSphere(0);
  small.vertices *= 0.5;
  for (int f = 0; f < small.faces.rows(); ++f) Turn(f, &small);
  const int first = static_cast<int>(mesh.faces.rows());
  Append(small, &mesh);
  const CheckMeshResult result = Check(mesh);
  ASSERT_EQ(result.components.size(), 2u);
  EXPECT_EQ(result.components[0].num_faces, first);
  EXPECT_EQ(result.components[1].num_faces, 20);
  EXPECT_EQ(result.components[1].turned_faces, 20);
  ASSERT_EQ(result.turned_faces.size(), 20u);
  EXPECT_EQ(result.turned_faces[0], first) << "the ball inside faces outwards too";
}

TEST(MeshCheck, ASheetGoesByTheSideThatMostFacesShow) {
  TestMesh sheet = MeshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}},
                          {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}});
  Turn(3, &sheet);
  const CheckMeshResult result = Check(sheet);
  EXPECT_EQ(result.turned_faces, std::vector<int>{3});
  EXPECT_EQ(result.components[0].volume_m3, 0);
}

TEST(MeshCheck, AMoebiusStripHasNoSides) {
  // Five triangles around, the last joined to the first with its ends exchanged.
  const TestMesh strip = MeshOf({{0, 0, 0}, {1, 0, 0}, {1.5, 1, 0}, {0.5, 1.6, 0.3}, {-0.5, 1, 0.5}},
                                {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}});
  const CheckMeshResult result = Check(strip);
  ASSERT_EQ(result.components.size(), 1u);
  EXPECT_FALSE(result.components[0].is_orientable);
  EXPECT_TRUE(result.turned_faces.empty());
  EXPECT_FALSE(result.IsClean());
}

TEST(MeshCheck, AnEdgeOfThreeFacesIsNamed) {
  TestMesh mesh = Tetrahedron();
  mesh.vertices.conservativeResize(5, 3);
  mesh.vertices.row(4) << 1, -1, 1;
  AddFaces({{0, 1, 4}}, &mesh);  // a fin
  const CheckMeshResult result = Check(mesh);
  ASSERT_EQ(result.non_manifold_edges.size(), 1u);
  EXPECT_EQ(result.non_manifold_edges[0], (std::array<int, 2>{0, 1}));
  EXPECT_TRUE(result.non_manifold_vertices.empty()) << "across the edge all faces are one fan";
  EXPECT_EQ(result.boundary_edges, 2);
}

TEST(MeshCheck, APinchedVertexIsNamed) {
  // Two tetrahedra that share vertex 0.
  TestMesh mesh = Tetrahedron();
  mesh.vertices.conservativeResize(7, 3);
  mesh.vertices.bottomRows(3) << -1, 0, 0, 0, -1, 0, 0, 0, -1;
  AddFaces({{0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}}, &mesh);
  const CheckMeshResult result = Check(mesh);
  EXPECT_EQ(result.non_manifold_vertices, std::vector<int>{0});
  EXPECT_TRUE(result.non_manifold_edges.empty());
  EXPECT_EQ(result.components.size(), 2u);
  EXPECT_TRUE(result.turned_faces.empty());
}

TEST(MeshCheck, SuperfluousFacesAreListedOnce) {
  TestMesh mesh = Tetrahedron();
  AddFaces({{1, 2, 3}, {2, 1, 3}, {3, 3, 1}, {2, 2, 2}}, &mesh);
  const CheckMeshResult result = Check(mesh);
  EXPECT_EQ(result.duplicate_faces, (std::vector<int>{4, 5}));
  EXPECT_EQ(result.repeated_corner_faces, (std::vector<int>{6, 7}));
  EXPECT_EQ(SuperfluousFaces(result), (std::vector<int>{4, 5, 6, 7}));
  EXPECT_TRUE(result.non_manifold_edges.empty()) << "a doubled face is one fault";
  EXPECT_EQ(result.boundary_edges, 0);
}

TEST(MeshCheck, AFaceWithoutAreaIsNamed) {
  // A vertex in the middle of an edge, with the needle that closes the gap.
  TestMesh mesh = Tetrahedron();
  mesh.vertices.conservativeResize(5, 3);
  mesh.vertices.row(4) << 0.5, 0, 0;
  mesh.faces.row(1) << 0, 4, 3;
  AddFaces({{4, 1, 3}, {0, 1, 4}}, &mesh);
  const CheckMeshResult result = Check(mesh);
  EXPECT_EQ(result.flat_faces, std::vector<int>{5});
  EXPECT_EQ(result.boundary_edges, 0);
  mesh.vertices(4, 1) = -1e-5;  // 10 µm high
  EXPECT_TRUE(Check(mesh).flat_faces.empty());
  EXPECT_EQ(CheckMesh(mesh.vertices, mesh.faces, {.flat_height_m = 2e-5}).flat_faces, std::vector<int>{5});
}

TEST(MeshCheck, VerticesAtOnePlaceAndInNoFace) {
  TestMesh mesh = Tetrahedron();
  mesh.vertices.conservativeResize(8, 3);
  mesh.vertices.row(4) << 5, 5, 5;
  mesh.vertices.row(5) = mesh.vertices.row(1);
  mesh.vertices.row(6) << 1, 1e-3, 0;
  mesh.vertices.row(7) << 1, 2e-3, 0;
  mesh.faces.row(3) << 5, 2, 3;  // comes loose
  CheckMeshResult result = Check(mesh);
  EXPECT_EQ(result.unreferenced_vertices, (std::vector<int>{4, 6, 7}));
  ASSERT_EQ(result.duplicate_vertices.size(), 1u);
  EXPECT_EQ(result.duplicate_vertices[0], (std::array<int, 2>{5, 1}));
  EXPECT_EQ(result.boundary_loops.size(), 1u);
  EXPECT_EQ(result.boundary_edges, 4);
  // Within 1.1 mm: 6 is at 1's place; 7 is near 6, which stands for no place, and not near 1.
  result = CheckMesh(mesh.vertices, mesh.faces, {.same_place_m = 1.1e-3});
  ASSERT_EQ(result.duplicate_vertices.size(), 2u);
  EXPECT_EQ(result.duplicate_vertices[1], (std::array<int, 2>{6, 1}));
}

TEST(MeshCheck, NegativeZeroIsZero) {
  TestMesh mesh = Tetrahedron();
  mesh.vertices.conservativeResize(5, 3);
  mesh.vertices.row(4) << -0.0, 0.0, -0.0;
  EXPECT_EQ(Check(mesh).duplicate_vertices.size(), 1u);
}

TEST(MeshCheck, WrongArgumentsAreRefused) {
  TestMesh mesh = Tetrahedron();
  mesh.faces(2, 1) = 4;
  EXPECT_THROW(Check(mesh), std::invalid_argument);
  mesh.faces(2, 1) = -1;
  EXPECT_THROW(Check(mesh), std::invalid_argument);
  mesh = Tetrahedron();
  EXPECT_THROW(CheckMesh(mesh.vertices, mesh.faces, {.same_place_m = -1}), std::invalid_argument);
  mesh.vertices(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Check(mesh), std::invalid_argument);
}

TEST(MeshCheck, AMeshWithoutFacesIsNotClean) {
  const CheckMeshResult result = CheckMesh(MatrixX3d::Zero(0, 3), MatrixX3i(0, 3));
  EXPECT_TRUE(result.components.empty());
  EXPECT_FALSE(result.IsClean());
}

/// OpenMesh's half-edges take exactly the meshes without non-manifold edges, pinched vertices and turned faces, and
/// count the same boundary.
TEST(MeshCheck, OpenMeshAgreesOnRandomDamage) {
  omerr().disable();  // says what it refuses
  std::mt19937 random(5);
  int refused = 0, taken = 0;
  for (int round = 0; round < 200; ++round) {
    TestMesh mesh = UnitSphere(1);
    std::uniform_int_distribution<int> any_face(0, static_cast<int>(mesh.faces.rows()) - 1);
    const int kind = round % 4;
    if (kind == 0) Turn(any_face(random), &mesh);
    if (kind == 1)
      mesh.faces.row(any_face(random)) = mesh.faces.bottomRows<1>().eval(),
      mesh.faces = MatrixX3i(mesh.faces.topRows(mesh.faces.rows() - 1));
    if (kind == 2) mesh.faces = MatrixX3i(mesh.faces.topRows(mesh.faces.rows() - 1 - any_face(random) % 8));
    if (kind == 3) {  // two vertices become one
      const int a = any_face(random) % 42, b = any_face(random) % 42;
      mesh.faces = mesh.faces.unaryExpr([&](int v) { return v == a ? b : v; }).eval();
    }
    const CheckMeshResult result = Check(mesh);
    if (!SuperfluousFaces(result).empty()) continue;  // OpenMesh would end the program
    using Half = OpenMesh::TriMesh_ArrayKernelT<>;
    Half half;
    std::vector<Half::VertexHandle> handles;
    for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v) {
      handles.push_back(
          half.add_vertex({float(mesh.vertices(v, 0)), float(mesh.vertices(v, 1)), float(mesh.vertices(v, 2))}));
    }
    bool takes = true;
    for (Eigen::Index f = 0; f < mesh.faces.rows() && takes; ++f) {
      takes = half.add_face(handles[mesh.faces(f, 0)], handles[mesh.faces(f, 1)], handles[mesh.faces(f, 2)]).is_valid();
    }
    const bool manifold =
        result.non_manifold_edges.empty() && result.non_manifold_vertices.empty() && result.inconsistent_edges == 0;
    if (!takes) {
      EXPECT_FALSE(manifold) << "round " << round;
      ++refused;
      continue;
    }
    ++taken;
    int boundary = 0;
    for (const auto edge : half.edges()) boundary += half.is_boundary(edge) ? 1 : 0;
    EXPECT_EQ(result.boundary_edges, boundary) << "round " << round;
    EXPECT_EQ(result.inconsistent_edges, 0) << "round " << round;
    EXPECT_TRUE(result.non_manifold_edges.empty()) << "round " << round;
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(taken, 50);
}

}  // namespace
}  // namespace bodyloom::mesh_check_test
