// SPDX-License-Identifier: Apache-2.0
#include "render/raster/visible_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::visible_points_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d PointOf(const MatrixX3d& vertices, int face, const Vector3d& b) {
  const auto corners = ToyBody().data().faces.row(face);
  return (b[0] * vertices.row(corners[0]) + b[1] * vertices.row(corners[1]) + b[2] * vertices.row(corners[2]))
      .transpose();
}

class VisiblePointsOfCamera : public testing::TestWithParam<Camera> {};

TEST_P(VisiblePointsOfCamera, ProjectBackOntoTheirPixels) {
  const Camera& camera = GetParam();
  const MatrixX3d vertices = PoseVertices(ToyBody(), Eigen::VectorXd(), RandomPose(ToyBody(), 11, 1.0, 2.5));
  VisibilityBuffer buffer;
  buffer.Render(vertices, ToyBody().data().faces, camera);
  const VisiblePoints points =
      ResolveVisiblePoints(buffer, ToyBody(), vertices, camera, {.part = true, .chart_uv = true, .depth = true});
  ASSERT_GT(points.size(), 1000u);
  int exact = 0;
  // With a distorting lens edges are drawn straight; the surface there ends up to a fraction of a pixel elsewhere.
  const double worst_px = camera.HasDistortion() ? 0.2 : 0.01;
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(buffer.FaceAt(points.x[i], points.y[i]), points.face[i]);
    ASSERT_GE(points.barycentric[i].minCoeff(), 0);
    ASSERT_NEAR(points.barycentric[i].sum(), 1, 1e-12);
    const Vector3d X = PointOf(vertices, points.face[i], points.barycentric[i]);
    Vector2d pixel;
    ASSERT_TRUE(camera.Project(X, &pixel));
    const double error_px = (pixel - Vector2d(points.x[i], points.y[i])).norm();
    ASSERT_LT(error_px, worst_px) << "pixel " << points.x[i] << " " << points.y[i];
    exact += error_px < 1e-8;
    ASSERT_NEAR(points.depth_m[i], X.z(), 1e-5);
    ASSERT_EQ(points.part[i], ToyBody().data().face_part[points.face[i]]);
    ASSERT_GE(points.chart_uv[i].minCoeff(), 0);
    ASSERT_LE(points.chart_uv[i].maxCoeff(), 1);
  }
  EXPECT_GT(exact, 0.98 * points.size());
}

INSTANTIATE_TEST_SUITE_P(All, VisiblePointsOfCamera,
                         testing::Values(MakePinhole(160, 160, 180), DistortedCamera(160, 160, 180),
                                         WeakCamera(160, 160, 75)));

TEST(VisiblePoints, AreCorrectInPerspective) {
  // A steep face from 1 to 9 m: the middle of its image is not the middle of the face.
  MatrixX3d vertices(3, 3);
  vertices << -1, 1, 1, 1, 1, 1, 0, 1, 9;
  MatrixX3i faces(1, 3);
  faces << 0, 1, 2;
  const Camera camera = MakePinhole(101, 101, 50);
  const Vector3d b = BarycentricAtPixel(vertices, faces, camera, 0, Vector2d(50, 50 + 50.0 / 3));  // meets z = 3
  EXPECT_NEAR(b[2], 0.25, 1e-12);
  EXPECT_NEAR(b[0], b[1], 1e-12);
}

TEST(VisiblePoints, GiveOnlyWhatIsAskedFor) {
  const Camera camera = MakePinhole(60, 60, 60);
  const MatrixX3d vertices = PoseVertices(ToyBody(), Eigen::VectorXd(), RandomPose(ToyBody(), 12, 1.0, 2.5));
  VisibilityBuffer buffer;
  buffer.Render(vertices, ToyBody().data().faces, camera);
  const VisiblePoints points = ResolveVisiblePoints(buffer, ToyBody(), vertices, camera);
  EXPECT_GT(points.size(), 0u);
  EXPECT_TRUE(points.part.empty());
  EXPECT_TRUE(points.chart_uv.empty());
  EXPECT_TRUE(points.depth_m.empty());
}

TEST(VisiblePoints, LeftOfTheBodyHasLeftParts) {
  const Camera camera = MakePinhole(120, 120, 130);
  const BodyPose pose = PoseFromAxisAngle(ToyBody(), RandomAxisAngle(ToyBody(), 0, 0), Vector3d(0, -0.2, 2.5));
  const MatrixX3d vertices = PoseVertices(ToyBody(), Eigen::VectorXd(), pose);
  VisibilityBuffer buffer;
  buffer.Render(vertices, ToyBody().data().faces, camera);
  const VisiblePoints points = ResolveVisiblePoints(buffer, ToyBody(), vertices, camera, {.part = true});
  int left_hand = 0, back = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    // The person faces the camera: its left hand (4) is on the right of the image.
    back += points.part[i] == 1;
    if (points.part[i] != 4) continue;
    ++left_hand;
    EXPECT_GT(points.x[i], 80);
  }
  EXPECT_GT(left_hand, 5);
  EXPECT_LT(back, 20);
}

TEST(VisiblePoints, RefuseChartsOfABodyWithoutThem) {
  BodyModelData data = ToyBodyData();
  data.face_part.clear();
  data.face_iuv.resize(0, 6);
  const BodyModel plain(std::move(data));
  const Camera camera = MakePinhole(60, 60, 60);
  const MatrixX3d vertices = PoseVertices(plain, Eigen::VectorXd(), RandomPose(plain, 12, 1.0, 2.5));
  VisibilityBuffer buffer;
  buffer.Render(vertices, plain.data().faces, camera);
  EXPECT_THROW(ResolveVisiblePoints(buffer, plain, vertices, camera, {.part = true}), std::invalid_argument);
  EXPECT_THROW(ResolveVisiblePoints(buffer, plain, vertices, camera, {.chart_uv = true}), std::invalid_argument);
  EXPECT_NO_THROW(ResolveVisiblePoints(buffer, plain, vertices, camera));
}

}  // namespace
}  // namespace bodyloom::visible_points_test
