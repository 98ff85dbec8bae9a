// SPDX-License-Identifier: Apache-2.0
// The visibility buffer against Embree's ray tracer, which shares neither code nor method with it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"
#include "render/raster/visibility_buffer.h"
#include "tests/support/embree_twin.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::embree_test {
namespace {

struct Tally {
  int covered = 0, compared = 0, beside_an_edge = 0, wrong = 0;
};

Tally Compare(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera, double near_m,
              double margin_px) {
  VisibilityBuffer buffer;
  buffer.Render(vertices, faces, camera, {.cull_back_faces = false, .near_m = near_m, .num_threads = 2});
  EmbreeTwin embree(faces);
  embree.See(vertices, camera, near_m);
  Tally tally;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const int ours = buffer.FaceAt(x, y), theirs = embree.face[size_t(y) * camera.width + x];
      tally.covered += ours >= 0;
      if (ours == theirs) {
        tally.compared += ours >= 0;
        continue;
      }
      bool near_edge = false;
      for (const int face : {ours, theirs}) {
        near_edge = near_edge || (face >= 0 && DistanceToEdges(vertices, faces, camera, face, x, y) < margin_px);
      }
      const double depth = embree.depth[size_t(y) * camera.width + x];
      const bool tied = ours >= 0 && theirs >= 0 && std::abs(buffer.DepthAt(x, y) / depth - 1) < 1e-5;
      if (near_edge || tied) {
        ++tally.beside_an_edge;
      } else if (++tally.wrong <= 5) {
        ADD_FAILURE() << "pixel " << x << " " << y << ": face " << ours << ", Embree " << theirs << "; depth "
                      << buffer.DepthAt(x, y) << " and " << depth;
      }
    }
  }
  return tally;
}

TEST(Embree, SeesTheSameFacesOfTheBuiltInBodyInManyPoses) {
  const BodyModel& body = BuiltinBody();
  const Eigen::VectorXd betas = Eigen::VectorXd::Zero(body.num_betas());
  int covered = 0, beside = 0;
  for (uint32_t seed = 1; seed <= 6; ++seed) {
    const MatrixX3d vertices = PoseVertices(body, betas, RandomPose(body, seed, 1.0, 2.4));
    for (const Camera& camera : {MakePinhole(320, 320, 380), WeakCamera(320, 320, 150)}) {
      const Tally tally = Compare(vertices, body.data().faces, camera, 0.01, 0.02);
      EXPECT_EQ(tally.wrong, 0);
      covered += tally.covered, beside += tally.beside_an_edge;
    }
  }
  EXPECT_GT(covered, 100000);
  EXPECT_LT(beside, covered / 100);  // the policy leaves out next to nothing
}

TEST(Embree, SeesTheSameFacesThroughADistortingLens) {
  // Between distorted corners the buffer draws straight edges; faces of a few pixels bend by less than 0.1 px.
  const BodyModel& body = BuiltinBody();
  const MatrixX3d vertices = PoseVertices(body, Eigen::VectorXd::Zero(body.num_betas()), RandomPose(body, 7, 0.8, 2.4));
  const Tally tally = Compare(vertices, body.data().faces, DistortedCamera(320, 320, 380), 0.01, 0.1);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.covered, 10000);
  EXPECT_LT(tally.beside_an_edge, tally.covered / 50);
}

TEST(Embree, SeesTheSameFacesOfABodyThroughTheCamera) {
  const BodyModel& body = BuiltinBody();
  for (const double distance_m : {0.3, 0.05}) {
    const MatrixX3d vertices =
        PoseVertices(body, Eigen::VectorXd::Zero(body.num_betas()), RandomPose(body, 8, 0.8, distance_m));
    const Tally tally = Compare(vertices, body.data().faces, MakePinhole(320, 320, 200), 0.02, 0.02);
    EXPECT_EQ(tally.wrong, 0) << distance_m;
    EXPECT_GT(tally.covered, 10000);
  }
}

TEST(Embree, SeesTheSameFacesOfRandomTriangles) {
  std::mt19937 generator(9);
  const auto uniform = [&] { return generator() / 4294967296.0 * 2 - 1; };
  const int count = 600;
  MatrixX3d vertices(3 * count, 3);
  MatrixX3i faces(count, 3);
  for (int f = 0; f < count; ++f) {
    const double size = std::pow(10.0, -1.8 + 1.5 * std::abs(uniform()));
    const Eigen::RowVector3d middle{uniform(), uniform(), 3 + uniform()};
    for (int c = 0; c < 3; ++c) {
      vertices.row(3 * f + c) = middle + size * Eigen::RowVector3d{uniform(), uniform(), uniform()};
      faces(f, c) = 3 * f + c;
    }
  }
  for (const Camera& camera : {MakePinhole(300, 300, 330), WeakCamera(300, 300, 120)}) {
    const Tally tally = Compare(vertices, faces, camera, 0.01, 0.02);
    EXPECT_EQ(tally.wrong, 0);
    EXPECT_GT(tally.compared, 20000);
    EXPECT_LT(tally.beside_an_edge, tally.covered / 50);
  }
}

}  // namespace
}  // namespace bodyloom::embree_test
