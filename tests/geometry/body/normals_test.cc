// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/normals.h"

#include <gtest/gtest.h>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "geometry/body/posed_body.h"
#include "geometry/body/skinning_simd.h"
#include "tests/support/meshes.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::normals_test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;
/// Rounding of a float normal, with room.
constexpr double kFloatRad = 2e-6;

struct Normals {
  MatrixX3f normals;
  NormalSummary summary;
};

Normals NormalsOf(const MatrixX3d& vertices, const MatrixX3i& faces, NormalWeighting weighting = NormalWeighting::kArea,
                  const NormalFallback& fallback = {}) {
  const MatrixX3f points = vertices.cast<float>();
  Normals result{MatrixX3f::Constant(vertices.rows(), 3, std::nanf("")), {}};
  NormalScratch scratch;
  result.summary = MeshNormals(faces, static_cast<int>(vertices.rows()), weighting)
                       .Compute({points.data(), static_cast<size_t>(points.size())},
                                {result.normals.data(), static_cast<size_t>(points.size())}, &scratch, fallback);
  return result;
}

/// Largest angle between rows; NaN counts as π.
double LargestAngle(const MatrixX3f& a, const MatrixX3d& b) {
  double largest = 0;
  for (Eigen::Index v = 0; v < a.rows(); ++v) {
    const Vector3d x = a.row(v).transpose().cast<double>(), y = b.row(v).transpose();
    const double angle = std::atan2(x.cross(y).norm(), x.dot(y));
    if (!(angle <= largest)) largest = std::isnan(angle) ? M_PI : angle;
  }
  return largest;
}

/// The definition, in double, one vertex after the other.
MatrixX3d SlowNormals(const MatrixX3d& vertices, const MatrixX3i& faces, NormalWeighting weighting) {
  MatrixX3d sum = MatrixX3d::Zero(vertices.rows(), 3);
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Vector3d p = vertices.row(faces(f, k)).transpose();
      const Vector3d a = vertices.row(faces(f, (k + 1) % 3)).transpose() - p;
      const Vector3d b = vertices.row(faces(f, (k + 2) % 3)).transpose() - p;
      const Vector3d cross = a.cross(b);
      if (cross.norm() == 0) continue;
      const double weight =
          weighting == NormalWeighting::kArea ? 0.5 * cross.norm() : std::atan2(cross.norm(), a.dot(b));
      sum.row(faces(f, k)) += weight * cross.normalized().transpose();
    }
  }
  return sum.rowwise().normalized();
}

MatrixX3d OpenMeshNormals(const MatrixX3d& vertices, const MatrixX3i& faces) {
  struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
  };
  OpenMesh::TriMesh_ArrayKernelT<Traits> mesh;
  std::vector<OpenMesh::VertexHandle> handles;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    handles.push_back(mesh.add_vertex({vertices(v, 0), vertices(v, 1), vertices(v, 2)}));
  }
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    mesh.add_face(handles[faces(f, 0)], handles[faces(f, 1)], handles[faces(f, 2)]);
  }
  mesh.request_face_normals();
  mesh.update_face_normals();
  MatrixX3d normals(vertices.rows(), 3);
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    OpenMesh::Vec3d n;
    mesh.calc_vertex_normal_correct(handles[v], n);  // the sum of cross products of edges: twice the areas
    normals.row(v) << n[0], n[1], n[2];
  }
  return normals.rowwise().normalized();
}

MatrixX3d ToyVertices(uint32_t seed) {
  const BodyPose pose = RandomPose(ToyBody(), seed, 1.0, 0);
  return PoseVertices(ToyBody(), Eigen::VectorXd(), pose);
}

class NormalsTarget : public ::testing::TestWithParam<int64_t> {
 protected:
  void SetUp() override { skinning_internal::ForceSimdTarget(GetParam()); }
  void TearDown() override { skinning_internal::ForceSimdTarget(0); }
};

TEST_P(NormalsTarget, OfTheSphereAreItsPoints) {
  for (const auto& [levels, limit_deg] : {std::pair{3, 0.35}, {5, 0.03}}) {
    const TestMesh sphere = UnitSphere(levels);
    for (const NormalWeighting weighting : {NormalWeighting::kArea, NormalWeighting::kAngle}) {
      const Normals found = NormalsOf(sphere.vertices, sphere.faces, weighting);
      // The mesh is symmetric about few of its points: the error falls with the square of the edge length.
      const double limit = weighting == NormalWeighting::kAngle ? limit_deg : 2.6 * limit_deg;
      EXPECT_LT(LargestAngle(found.normals, sphere.vertices) / kDegree, limit) << levels;
      EXPECT_EQ(found.summary.degenerate_faces, 0);
      EXPECT_EQ(found.summary.meshes, 1);
      EXPECT_NEAR((found.normals.rowwise().norm().array() - 1).abs().maxCoeff(), 0, 3e-7);
    }
  }
}

TEST_P(NormalsTarget, AgreeWithTheDefinitionAndWithOpenMesh) {
  for (const uint32_t seed : {1U, 2U, 3U}) {
    const MatrixX3d vertices = ToyVertices(seed).cast<float>().cast<double>();
    const MatrixX3i& faces = ToyBody().data().faces;
    const Normals area = NormalsOf(vertices, faces), angle = NormalsOf(vertices, faces, NormalWeighting::kAngle);
    EXPECT_LT(LargestAngle(area.normals, SlowNormals(vertices, faces, NormalWeighting::kArea)), 3e-5);
    EXPECT_LT(LargestAngle(angle.normals, SlowNormals(vertices, faces, NormalWeighting::kAngle)), 3e-5);
    EXPECT_LT(LargestAngle(area.normals, OpenMeshNormals(vertices, faces)), 3e-5);
    EXPECT_GT(LargestAngle(area.normals, angle.normals.cast<double>()), 0.5 * kDegree);  // they are two things
  }
}

TEST_P(NormalsTarget, ByAngleDoNotDependOnTheTriangulation) {
  // A cube whose sides are split along whichever diagonal: at every corner three right angles meet.
  MatrixX3d cube(8, 3);
  for (int i = 0; i < 8; ++i) cube.row(i) << (i & 1 ? 1 : -1), (i & 2 ? 1 : -1), (i & 4 ? 1 : -1);
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int diagonals = 0; diagonals < 64; ++diagonals) {
    MatrixX3i faces(12, 3);
    for (int q = 0; q < 6; ++q) {
      const int s = diagonals >> q & 1;
      const int* c = quads[q];
      faces.row(2 * q) << c[s], c[s + 1], c[(s + 2) % 4];
      faces.row(2 * q + 1) << c[s], c[(s + 2) % 4], c[(s + 3) % 4];
    }
    const Normals found = NormalsOf(cube, faces, NormalWeighting::kAngle);
    ASSERT_LT(LargestAngle(found.normals, cube.rowwise().normalized()), kFloatRad) << diagonals;
  }
}

TEST_P(NormalsTarget, DoNotDependOnTheUnitOfLength) {
  const MatrixX3d vertices = ToyVertices(4);
  const MatrixX3i& faces = ToyBody().data().faces;
  for (const NormalWeighting weighting : {NormalWeighting::kArea, NormalWeighting::kAngle}) {
    const Normals one = NormalsOf(vertices, faces, weighting);
    for (const double scale : {1e-15, 1e-6, 1e-3, 1e3, 1e9, 1e15}) {
      const Normals other = NormalsOf(scale * vertices, faces, weighting);
      EXPECT_LT(LargestAngle(other.normals, one.normals.cast<double>()), 3e-4) << scale;
      EXPECT_EQ(other.summary.degenerate_faces, 0) << scale;
    }
    // A power of two changes no bit.
    EXPECT_EQ(NormalsOf(std::ldexp(1.0, 40) * vertices, faces, weighting).normals, one.normals);
  }
}

TEST_P(NormalsTarget, TurnWithTheMesh) {
  const MatrixX3d vertices = ToyVertices(5);
  const MatrixX3i& faces = ToyBody().data().faces;
  const Eigen::Matrix3d R = RotationFromAxisAngle(Vector3d(0.3, -1.2, 0.7));
  const Normals before = NormalsOf(vertices, faces), after = NormalsOf(vertices * R.transpose(), faces);
  EXPECT_LT(LargestAngle(after.normals, before.normals.cast<double>() * R.transpose()), 1e-4);
}

TEST_P(NormalsTarget, ForgetFacesOfNoArea) {
  const TestMesh sphere = UnitSphere(3);
  const Normals clean = NormalsOf(sphere.vertices, sphere.faces);
  // Faces that are one point, an edge there and back, and three points in a row.
  MatrixX3d vertices(sphere.vertices.rows() + 1, 3);
  vertices << sphere.vertices, 0.5 * (sphere.vertices.row(0) + sphere.vertices.row(sphere.faces(0, 1)));
  vertices.row(sphere.vertices.rows()) =
      0.5 * (sphere.vertices.row(sphere.faces(0, 0)) + sphere.vertices.row(sphere.faces(0, 1)));
  const int extra = static_cast<int>(sphere.vertices.rows());
  MatrixX3i faces(sphere.faces.rows() + 3, 3);
  faces << sphere.faces, Eigen::RowVector3i(7, 7, 7), Eigen::RowVector3i(3, 9, 3),
      Eigen::RowVector3i(sphere.faces(0, 0), extra, sphere.faces(0, 1));
  for (const NormalWeighting weighting : {NormalWeighting::kArea, NormalWeighting::kAngle}) {
    const Normals found = NormalsOf(vertices, faces, weighting);
    EXPECT_EQ(found.summary.degenerate_faces, 3);
    EXPECT_EQ(found.summary.from_neighbours, 1);  // the point that has only the last of them
    EXPECT_EQ(found.summary.undefined, 0);
    const MatrixX3d expected =
        (weighting == NormalWeighting::kArea ? clean.normals
                                             : NormalsOf(sphere.vertices, sphere.faces, weighting).normals)
            .cast<double>();
    EXPECT_LT(LargestAngle(found.normals.topRows(extra), expected), kFloatRad);
    EXPECT_LT(LargestAngle(found.normals.bottomRows(1), vertices.bottomRows(1).rowwise().normalized()), 2 * kDegree);
  }
}

TEST_P(NormalsTarget, KnowAFaceThatIsAllRounding) {
  // Three points on a line through the root: whatever area they have is the rounding of their coordinates.
  std::mt19937 random(2);
  const int n = 200;
  MatrixX3d vertices(3 * n, 3);
  MatrixX3i faces(n, 3);
  for (int i = 0; i < n; ++i) {
    const auto uniform = [&] { return random() / 4294967296.0 * 2 - 1; };
    const Vector3d direction{uniform(), uniform(), uniform()};
    for (int k = 0; k < 3; ++k) vertices.row(3 * i + k) = (0.4 * k - 0.5 + 0.1 * uniform()) * direction.transpose();
    faces.row(i) << 3 * i, 3 * i + 1, 3 * i + 2;
  }
  const Normals found = NormalsOf(vertices, faces);
  EXPECT_EQ(found.summary.degenerate_faces, n);
  EXPECT_EQ(found.summary.undefined, 3 * n);
}

TEST_P(NormalsTarget, OfThinFacesStayGood) {
  // A flat strip of needles, 2 mm long and a ten-thousandth as wide, a metre from the root.
  const int n = 200;
  const Eigen::Matrix3d R = RotationFromAxisAngle(Vector3d(0.4, 0.3, -0.8));
  MatrixX3d vertices(2 * n, 3);
  MatrixX3i faces(2 * (n - 1), 3);
  for (int i = 0; i < n; ++i) {
    vertices.row(2 * i) << 0.01 * i, 0, 0;
    vertices.row(2 * i + 1) << 0.01 * i, 1e-6, 0;
    if (i + 1 < n) {
      faces.row(2 * i) << 2 * i, 2 * i + 2, 2 * i + 1;
      faces.row(2 * i + 1) << 2 * i + 1, 2 * i + 2, 2 * i + 3;
    }
  }
  const Normals found = NormalsOf(vertices * R.transpose(), faces);
  EXPECT_TRUE(found.normals.allFinite());
  for (Eigen::Index v = 0; v < found.normals.rows(); ++v) ASSERT_NEAR(found.normals.row(v).norm(), 1, 1e-6);
}

std::string TargetLabel(const ::testing::TestParamInfo<int64_t>& info) {
  return skinning_internal::SimdTargetName(info.param);
}
INSTANTIATE_TEST_SUITE_P(Simd, NormalsTarget, ::testing::ValuesIn(skinning_internal::SimdTargets()), TargetLabel);

TEST(Normals, InstructionSetsDifferOnlyInTheLastBits) {
  const MatrixX3d vertices = ToyVertices(6);
  for (const NormalWeighting weighting : {NormalWeighting::kArea, NormalWeighting::kAngle}) {
    const Normals best = NormalsOf(vertices, ToyBody().data().faces, weighting);
    for (const int64_t target : skinning_internal::SimdTargets()) {
      skinning_internal::ForceSimdTarget(target);
      const Normals other = NormalsOf(vertices, ToyBody().data().faces, weighting);
      skinning_internal::ForceSimdTarget(0);
      EXPECT_LT((best.normals - other.normals).cwiseAbs().maxCoeff(), 2e-6F);
    }
  }
}

TEST(Normals, FallBackToTheTemplateAndThenToNothing) {
  // A body shrunk to one point has no faces left; its normals are the template's, turned with the bones.
  const BodyModel& body = ToyBody();
  const MatrixX3f of_template = TemplateNormals(body);
  BodyPose pose;
  const Eigen::Matrix3d R = RotationFromAxisAngle(Vector3d(0.2, 0.9, -0.4));
  pose.rotations.assign(body.num_joints(), Eigen::Matrix3d::Identity());
  pose.rotations[0] = R;
  const PosedSkeleton skeleton = PoseSkeleton(body, body.joint_template(), pose);
  const MatrixX3d point = MatrixX3d::Constant(body.num_vertices(), 3, 0.25);
  const Normals turned = NormalsOf(point, body.data().faces, NormalWeighting::kArea, {&body, &of_template, &skeleton});
  EXPECT_EQ(turned.summary.from_template, body.num_vertices());
  EXPECT_EQ(turned.summary.degenerate_faces, body.num_faces());
  EXPECT_LT(LargestAngle(turned.normals, of_template.cast<double>() * R.transpose()), kFloatRad);

  const Normals none = NormalsOf(point, body.data().faces);
  EXPECT_EQ(none.summary.undefined, body.num_vertices());
  EXPECT_TRUE(none.normals.isZero(0));
  const Normals empty = NormalsOf(MatrixX3d::Zero(3, 3), MatrixX3i(0, 3));
  EXPECT_EQ(empty.summary.undefined, 3);
}

TEST(Normals, OfAFoldedSheetAreFilledFromItsNeighbours) {
  // Two faces back to back at vertex 0 cancel; it borrows from the face beyond.
  MatrixX3d vertices(4, 3);
  vertices << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0;
  MatrixX3i faces(3, 3);
  faces << 0, 1, 2, 0, 2, 1, 1, 3, 2;
  const Normals found = NormalsOf(vertices, faces);
  EXPECT_EQ(found.summary.from_neighbours, 1);
  EXPECT_NEAR(found.normals(0, 2), 1, 1e-6);
}

TEST(Normals, SameBytesForAnyNumberOfThreads) {
  const BodyModel& body = ToyBody();
  const size_t stride = 3 * size_t(body.num_vertices());
  const int T = 37;
  std::vector<float> vertices;
  for (int t = 0; t < T; ++t) {
    const MatrixX3f frame = ToyVertices(t).cast<float>();
    vertices.insert(vertices.end(), frame.data(), frame.data() + stride);
  }
  const MeshNormals normals(body.data().faces, body.num_vertices());
  std::vector<float> one(vertices.size()), many(vertices.size());
  EXPECT_EQ(normals.ComputeFrames(vertices, one, 1).meshes, T);
  for (const int threads : {2, 3, 8}) {
    std::fill(many.begin(), many.end(), 0.0F);
    normals.ComputeFrames(vertices, many, threads);
    EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(float)), 0) << threads;
  }
}

TEST(Normals, RefuseWhatTheyCannotUse) {
  const TestMesh sphere = UnitSphere(0);
  MatrixX3i faces = sphere.faces;
  faces(3, 1) = 12;
  EXPECT_THROW(MeshNormals(faces, 12), std::invalid_argument);
  faces(3, 1) = -1;
  EXPECT_THROW(MeshNormals(faces, 12), std::invalid_argument);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (const int v : {0, 5, 11}) {
      MatrixX3d vertices = sphere.vertices;
      vertices(v, 2) = bad;
      EXPECT_THROW((void)NormalsOf(vertices, sphere.faces), std::invalid_argument);
    }
  }
  NormalScratch scratch;
  std::vector<float> in(36), out(35);
  EXPECT_THROW(MeshNormals(sphere.faces, 12).Compute(in, out, &scratch), std::invalid_argument);
}

TEST(MeshAdjacency, FindsTheFaceAcrossEveryEdge) {
  const TestMesh sphere = UnitSphere(2);
  const MeshAdjacency mesh = BuildMeshAdjacency(sphere.faces, static_cast<int>(sphere.vertices.rows()));
  EXPECT_EQ(mesh.num_boundary_edges, 0);
  EXPECT_EQ(mesh.num_non_manifold_edges, 0);
  const auto vertex = [&](int half_edge, int step) { return sphere.faces(half_edge / 3, (half_edge % 3 + step) % 3); };
  for (int h = 0; h < static_cast<int>(mesh.opposite.size()); ++h) {
    const int other = mesh.opposite[h];
    ASSERT_GE(other, 0);
    ASSERT_NE(other / 3, h / 3);
    ASSERT_EQ(mesh.opposite[other], h);
    ASSERT_EQ(vertex(h, 0), vertex(other, 1));
    ASSERT_EQ(vertex(h, 1), vertex(other, 0));
  }
  // One face taken away leaves three boundary edges; one doubled makes three with too many faces.
  MatrixX3i faces(sphere.faces.rows(), 3);
  faces << sphere.faces.topRows(sphere.faces.rows() - 1), sphere.faces.row(0);
  const MeshAdjacency odd = BuildMeshAdjacency(faces, static_cast<int>(sphere.vertices.rows()));
  EXPECT_EQ(odd.num_boundary_edges, 3);
  EXPECT_EQ(odd.num_non_manifold_edges, 3);
}

}  // namespace
}  // namespace bodyloom::normals_test
