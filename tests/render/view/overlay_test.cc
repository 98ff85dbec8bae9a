// SPDX-License-Identifier: Apache-2.0
#include "render/view/overlay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/body/normals.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "render/raster/visibility_buffer.h"
#include "render/view/shaded_mesh.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::overlay_test {
namespace {

using Eigen::Vector3d;

/// A body that stands, facing the camera, and steps sideways.
Track StandingTrack(int frames, const Camera& camera) {
  Track track;
  track.camera = camera;
  track.motion.up = Motion::Up::kCamera;
  track.motion.poses = RowMatrixXd::Zero(frames, 72);
  track.motion.trans.resize(frames, 3);
  for (int t = 0; t < frames; ++t) {
    track.motion.poses.row(t) = RandomAxisAngle(ToyBody(), 0, 0).transpose();
    track.motion.trans.row(t) << 0.1 * t, 0.2, 3;
    track.motion.timestamps.push_back(t / 30.0);
  }
  track.frame_status.assign(frames, FrameStatus::kTracked);
  return track;
}

KeypointSequence Detections(const Track& track) {
  KeypointSequence detected;
  detected.names = CocoNames();
  detected.names.push_back("neck");  // a name that the body does not know
  for (int t = 0; t < track.num_frames(); ++t) {
    detected.timestamps.push_back(track.motion.timestamps[t]);
    for (size_t k = 0; k < detected.names.size(); ++k) {
      detected.points.push_back({static_cast<float>(10 + 3 * k), static_cast<float>(20 + 4 * k), 0.8F});
    }
  }
  return detected;
}

/// Pixels of which a channel differs by more than rounding.
int DifferentPixels(const Image& a, const Image& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  int count = 0;
  for (size_t i = 0; i < a.bgr.size() && i < b.bgr.size(); ++i) count += std::abs(int{a.bgr[i]} - int{b.bgr[i]}) > 2;
  return count;
}

TEST(ShadedMesh, CoversWhatTheVisibilityBufferCovers) {
  const Camera camera = MakePinhole(160, 160, 170);
  const MatrixX3d vertices = PoseVertices(ToyBody(), Eigen::VectorXd(), RandomPose(ToyBody(), 21, 0.8, 2.5));
  const Image before(160, 160, {255, 0, 255});
  Image image = before;
  DrawMesh(vertices, ToyBody().data().faces, camera, {.contour_px = 0}, &image);
  VisibilityBuffer fine;
  fine.Render(vertices, ToyBody().data().faces, ScaledCamera(camera, 3));
  int inside = 0, outside = 0;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 160; ++x) {
      int covered = 0;
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) covered += fine.FaceAt(3 * x + i, 3 * y + j) >= 0;
      }
      const bool changed = !(image.at(x, y) == before.at(x, y));
      ASSERT_TRUE(covered > 0 || !changed) << x << " " << y;
      ASSERT_TRUE(covered < 9 || changed) << x << " " << y;
      inside += covered == 9;
      outside += covered == 0;
    }
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(outside, 500);
}

TEST(ShadedMesh, IsBrighterTowardsTheLight) {
  // A sphere: lit from the upper left.
  const int n = 24;
  MatrixX3d vertices((n + 1) * n, 3);
  MatrixX3i faces(2 * n * n, 3);
  for (int i = 0, f = 0; i <= n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double theta = M_PI * i / n, phi = 2 * M_PI * j / n;
      vertices.row(i * n + j) << std::sin(theta) * std::cos(phi), std::cos(theta), 4 + std::sin(theta) * std::sin(phi);
      if (i == n) continue;
      const int a = i * n + j, b = i * n + (j + 1) % n;
      faces.row(f++) << a, b, b + n;
      faces.row(f++) << a, b + n, a + n;
    }
  }
  const MatrixX3d normals = VertexNormals(vertices, faces).cast<double>();
  for (int v = n; v < n * n; ++v) {
    ASSERT_NEAR(std::abs(normals.row(v).dot(vertices.row(v) - Eigen::RowVector3d(0, 0, 4))), 1, 0.02) << v;
    ASSERT_GT(normals.row(v).dot(vertices.row(v) - Eigen::RowVector3d(0, 0, 4)), 0) << "inwards at " << v;
  }
  const Camera camera = MakePinhole(100, 100, 150);
  Image image(100, 100);
  DrawMesh(vertices, faces, camera, {}, &image);
  EXPECT_GT(image.at(38, 35).green, image.at(62, 65).green + 20);
  // The contour is dark, the sphere's rim at 99.5/2 + 150·(1/√15).
  EXPECT_LT(image.at(49 - 38, 49).green, image.at(35, 49).green / 2);
}

TEST(ShadedMesh, AlphaLetsTheVideoThrough) {
  const Camera camera = MakePinhole(80, 80, 90);
  const MatrixX3d vertices = PoseVertices(ToyBody(), Eigen::VectorXd(), RandomPose(ToyBody(), 0, 0, 2));
  Image solid(80, 80, {0, 0, 0}), half = solid;
  DrawMesh(vertices, ToyBody().data().faces, camera, {.alpha = 1, .contour_px = 0}, &solid);
  DrawMesh(vertices, ToyBody().data().faces, camera, {.alpha = 0.5, .contour_px = 0}, &half);
  EXPECT_NEAR(half.at(40, 35).blue, 0.5 * solid.at(40, 35).blue, 2);
  EXPECT_GT(solid.at(40, 35).blue, 80);
  Image wrong(81, 80);
  EXPECT_THROW(DrawMesh(vertices, ToyBody().data().faces, camera, {}, &wrong), std::invalid_argument);
  EXPECT_THROW(DrawMesh(vertices, ToyBody().data().faces, camera, {.face_colours = {kBodyColour}}, &solid),
               std::invalid_argument);
}

TEST(ViewCamera, ScaledCameraMovesPixelsWithTheImage) {
  const Camera camera = DistortedCamera(64, 48, 70), twice = ScaledCamera(camera, 2);
  const Vector3d X(0.2, -0.1, 1.3);
  Eigen::Vector2d p, q;
  ASSERT_TRUE(camera.Project(X, &p) && twice.Project(X, &q));
  EXPECT_LT((q - (2 * (p.array() + 0.5) - 0.5).matrix()).norm(), 1e-9);
  EXPECT_EQ(twice.width, 128);
}

TEST(ViewCamera, PixelsPerMetreAreThoseOfTheProjection) {
  Camera camera = MakePinhole(64, 48, 70);
  Eigen::Vector2d p, q;
  for (const CameraModel model : {CameraModel::kPinhole, CameraModel::kWeakPerspective}) {
    camera.model = model;
    camera.scale = 33;
    ASSERT_TRUE(camera.Project(Vector3d(0.2, -0.1, 2.5), &p) && camera.Project(Vector3d(0.2, 0.9, 2.5), &q));
    EXPECT_NEAR(PixelsPerMetre(camera, 2.5), q.y() - p.y(), 1e-9);
  }
  camera.model = CameraModel::kPinhole;
  EXPECT_EQ(PixelsPerMetre(camera, -1), 0) << "behind the camera";
  EXPECT_EQ(PixelsPerMetre(camera, std::nan("")), 0);
}

TEST(ViewCamera, OrbitSeesAllPointsFromTheSide) {
  MatrixX3d points(4, 3);
  points << 0, 0, 3, 0.4, 0, 3, 0, 0, 5, std::nan(""), 0, 0;
  const View view = OrbitView({points}, 120, 160, {.yaw_deg = 90});
  const MatrixX3d seen = view.Apply(points.topRows(3));
  for (int i = 0; i < 3; ++i) {
    Eigen::Vector2d pixel;
    ASSERT_TRUE(view.camera.Project(seen.row(i), &pixel));
    EXPECT_TRUE(pixel.x() >= 0 && pixel.x() < 120 && pixel.y() >= 0 && pixel.y() < 160) << pixel.transpose();
  }
  // From the person's left: what was nearer to the video camera lies on one side, what was further on the other, and
  // the person's left (image right) is nearer.
  EXPECT_NEAR(std::abs(seen(0, 0) - seen(2, 0)), 2, 1e-9);
  EXPECT_LT(seen(1, 2), seen(0, 2));
  EXPECT_NEAR((view.from_camera.camera_from_world_rotation.transpose() * view.from_camera.camera_from_world_rotation -
               Eigen::Matrix3d::Identity())
                  .norm(),
              0, 1e-12);
  EXPECT_THROW(OrbitView({points.bottomRows(1)}, 10, 10, {}), std::invalid_argument);
}

TEST(Overlay, DrawsTheBodyWhereTheCameraSeesIt) {
  const Track track = StandingTrack(3, MakePinhole(160, 120, 130));
  const OverlayRenderer renderer(ToyBody(), track);
  const Image video(160, 120, {0, 200, 0});
  const Image image = renderer.Render(2, {.background = &video});
  EXPECT_EQ(image.width, 160);
  Eigen::Vector2d pelvis;
  const MatrixX3d vertices = TrackVertices(ToyBody(), track, 2);
  ASSERT_TRUE(track.camera.Project(vertices.colwise().mean().transpose(), &pelvis));
  EXPECT_NE(image.at(int(pelvis.x()), int(pelvis.y())), video.at(0, 0));
  EXPECT_EQ(image.at(5, 5), video.at(0, 0));
  EXPECT_EQ(renderer.Render(2, {.background = &video}), image) << "same input, same bytes";
}

TEST(Overlay, ACameraThatMovesShowsEachFrameAsItSawIt) {
  Track seen = StandingTrack(2, MakePinhole(160, 160, 170));
  seen.motion.betas = Eigen::VectorXd::Zero(2);
  const std::vector<CameraPose> cameras = {{RotationFromAxisAngle({0.1, 0.2, 0.3}), {0.5, 0, 1}},
                                           {RotationFromAxisAngle({-0.2, 0.1, 0}), {0, 1, 0.2}}};
  Track track = seen;
  track.camera_from_scene = cameras;
  track.motion = MovedMotion(ToyBody(), seen.motion, std::vector<CameraPose>{Inverse(cameras[0]), Inverse(cameras[1])});
  OverlayOptions options;
  options.floor = false;
  const OverlayRenderer moving(ToyBody(), track, options), still(ToyBody(), seen, options);
  for (const int t : {0, 1}) EXPECT_EQ(DifferentPixels(moving.Render(t, {}), still.Render(t, {})), 0) << t;
}

TEST(Overlay, LostFramesShowTheVideoAlone) {
  Track track = StandingTrack(3, MakePinhole(160, 120, 130));
  track.motion.poses.row(1).setConstant(std::nan(""));
  track.motion.trans.row(1).setConstant(std::nan(""));
  const Image video(160, 120, {0, 200, 0});
  const OverlayRenderer renderer(ToyBody(), track);
  EXPECT_EQ(renderer.Render(1, {.background = &video}), video);
  EXPECT_EQ(TrackVertices(ToyBody(), track, 1).rows(), 0);
}

TEST(Overlay, SideViewShowsErrorsInDepth) {
  const Track truth = StandingTrack(6, MakePinhole(160, 120, 130));
  Track estimate = truth;
  estimate.motion.trans.col(2).array() += 0.5;  // along the view: hardly seen in front, plainly from the side
  OverlayOptions options;
  options.side_view = true;
  const OverlayRenderer right(ToyBody(), truth, options, &truth), wrong(ToyBody(), estimate, options, &truth);
  EXPECT_EQ(right.width(), 160 + 90);
  const Image drawn = wrong.Render(3, {}), reference = right.Render(3, {});
  EXPECT_EQ(drawn.width, right.width());
  // Orange (the truth) stands free of blue (the estimate) only when the depth is wrong.
  const auto orange = [](const Image& image) {
    int count = 0;
    for (int y = 0; y < image.height * 3 / 4; ++y) {
      for (int x = 160; x < image.width; ++x) {
        const Colour c = image.at(x, y);
        count += c.red > c.blue + 60;
      }
    }
    return count;
  };
  EXPECT_GT(orange(drawn), 150);
  EXPECT_LT(orange(reference), 40);
}

TEST(Overlay, SideViewHoldsLostFramesAndAWholeTrackOfThem) {
  Track track = StandingTrack(5, MakePinhole(160, 120, 130));
  track.motion.poses.row(0).setConstant(std::nan(""));
  track.motion.poses.row(3).setConstant(std::nan(""));
  OverlayOptions options;
  options.side_view = true;
  const OverlayRenderer renderer(ToyBody(), track, options);
  for (int t = 0; t < 5; ++t) EXPECT_NO_THROW(renderer.Render(t, {}));
  track.motion.poses.setConstant(std::nan(""));
  EXPECT_THROW(OverlayRenderer(ToyBody(), track, options), std::invalid_argument);
  EXPECT_NO_THROW(OverlayRenderer(ToyBody(), track).Render(0, {}));
}

TEST(Overlay, DrawsDetectionsOfKnownNames) {
  const Track track = StandingTrack(2, MakePinhole(160, 120, 130));
  const KeypointSequence detected = Detections(track);
  const Image video(160, 120, {0, 200, 0});
  for (const bool skeleton : {false, true}) {
    OverlayOptions options;
    options.skeleton = skeleton;
    const Image image =
        OverlayRenderer(ToyBody(), track, options).Render(1, {.background = &video, .detected = &detected});
    EXPECT_NE(image.at(10 + 3 * 14, 20 + 4 * 14), video.at(0, 0)) << "landmark 14";
  }
}

TEST(Overlay, WeakPerspectiveUsesTheCameraOfTheFrame) {
  Track track = StandingTrack(2, WeakCamera(160, 120, 50));
  track.weak_camera.resize(2, 3);
  track.weak_camera << 50, 0, -0.2, 50, 1, -0.2;
  track.motion.trans.row(1) = track.motion.trans.row(0);
  const Image video(160, 120, {0, 200, 0});
  const OverlayRenderer renderer(ToyBody(), track);
  const Image a = renderer.Render(0, {.background = &video}), b = renderer.Render(1, {.background = &video});
  EXPECT_NE(a.at(79, 60), video.at(0, 0));
  EXPECT_EQ(b.at(79 - 15, 60), video.at(0, 0));
  EXPECT_NE(b.at(79 + 50, 60), video.at(0, 0)) << "one metre, 50 px, further right";
}

TEST(Overlay, RefusesWhatDoesNotFit) {
  Track track = StandingTrack(2, MakePinhole(160, 120, 130));
  const Image wrong(161, 120);
  const OverlayRenderer renderer(ToyBody(), track);
  EXPECT_THROW(renderer.Render(0, {.background = &wrong}), std::invalid_argument);
  EXPECT_THROW(renderer.Render(2, {}), std::invalid_argument);
  EXPECT_THROW(renderer.Render(-1, {}), std::invalid_argument);
  OverlayOptions options;
  options.alpha = 1.5;
  EXPECT_THROW(OverlayRenderer(ToyBody(), track, options), std::invalid_argument);
  BodyModelData plain = ToyBodyData();
  plain.face_part.clear();
  const BodyModel no_parts(std::move(plain));
  options = {};
  options.colours = BodyColours::kParts;
  EXPECT_THROW(OverlayRenderer(no_parts, track, options), std::invalid_argument);
  EXPECT_NO_THROW(OverlayRenderer(ToyBody(), track, options).Render(0, {}));
  track.camera.width = 0;
  EXPECT_THROW(OverlayRenderer(ToyBody(), track), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::overlay_test
