// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/held_out_views.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <random>

#include "data_tools/evaluation/triangulated_clip.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::evaluation_held_out_test {
namespace {

constexpr int kFrames = 10;

CameraPose LookingAtOrigin(double angle) {
  CameraPose pose;
  pose.camera_from_world_rotation =
      RotationFromAxisAngle({M_PI, 0, 0}) * RotationFromAxisAngle({0, angle, 0});  // world y up, camera y down
  pose.camera_from_world_translation = Eigen::Vector3d(0.1, 0.2, 4);
  return pose;
}

/// A rig of three distorted cameras around a moving body, detections without noise.
struct Scene {
  MultiViewClip clip;
  Track track;  ///< the truth in the frame of view "b"
};

Scene MakeScene() {
  Scene scene;
  scene.clip.name = "scene";
  scene.clip.fps = 60;
  scene.clip.motion.poses.resize(kFrames, 72);
  scene.clip.motion.trans.resize(kFrames, 3);
  scene.track.motion.poses.resize(kFrames, 72);
  scene.track.motion.trans = MatrixX3d::Zero(kFrames, 3);
  for (int v = 0; v < 3; ++v) {
    RigView view;
    view.name = std::string(1, static_cast<char>('a' + v));
    view.camera = DistortedCamera(1920, 1080, 1300 + 20 * v);
    view.pose = LookingAtOrigin(2.1 * v);
    view.detections.names = CocoNames();
    scene.clip.views.push_back(view);
  }
  const CameraPose& b = scene.clip.views[1].pose;
  scene.track.camera = scene.clip.views[1].camera;
  const Eigen::VectorXd from = RandomAxisAngle(ToyBody(), 3, 0.5), to = RandomAxisAngle(ToyBody(), 4, 0.5);
  for (int t = 0; t < kFrames; ++t) {
    Eigen::VectorXd axis_angle = from + (to - from) * t / kFrames;
    axis_angle.head<3>() = Eigen::Vector3d(0, 0.3 + 0.05 * t, 0);  // upright in the world
    const BodyPose pose = PoseFromAxisAngle(ToyBody(), axis_angle, {0.03 * t, 0, 0});
    const MatrixX3d points = PoseLandmarks(ToyBody(), Eigen::VectorXd(), pose, CocoNames());
    scene.clip.coco17_in_world.push_back(points);
    scene.clip.motion.poses.row(t) = axis_angle.transpose();
    scene.track.motion.poses.row(t) = axis_angle.transpose();
    scene.track.motion.poses.row(t).head<3>() =
        AxisAngleFromRotation(b.camera_from_world_rotation * pose.rotations[0]).transpose();
    const auto in_camera = [&](const CameraPose& camera) -> MatrixX3d {
      return (points * camera.camera_from_world_rotation.transpose()).rowwise() +
             camera.camera_from_world_translation.transpose();
    };
    scene.track.coco17.push_back(in_camera(b));
    for (RigView& view : scene.clip.views) {
      view.detections.timestamps.push_back(t / 60.0);
      const MatrixX3d seen = in_camera(view.pose);
      for (int k = 0; k < 17; ++k) {
        Eigen::Vector2d pixel;
        EXPECT_TRUE(view.camera.Project(seen.row(k).transpose(), &pixel));
        view.detections.points.push_back({static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), 0.9F});
      }
    }
  }
  return scene;
}

TEST(EvaluationHeldOutTest, TheTrueTrackHasNoErrorInAnyView) {
  const Scene scene = MakeScene();
  const Evaluation e = EvaluateHeldOutViews(scene.track, scene.clip, "b");
  EXPECT_NEAR(e.Value("clip_scale"), 1, 1e-12);
  EXPECT_NEAR(e.Value("mpjpe_mm"), 0, 1e-9);
  EXPECT_NEAR(e.Value("pa_mpjpe_mm"), 0, 1e-9);
  EXPECT_NEAR(e.Value("accel_err_ms2"), 0, 1e-9);
  EXPECT_NEAR(e.Value("root_err_mm"), 0, 1e-9);
  EXPECT_NEAR(e.Value("heldout_p95_px"), 0, 1e-3);  // detections are floats
  EXPECT_NEAR(e.Value("fitview_p95_px"), 0, 1e-3);
  EXPECT_EQ(e.Value("heldout_pck_box_05"), 1);
  EXPECT_NEAR(e.Value("joint_angle_err_deg"), 0, 1e-6);
  EXPECT_NEAR(e.Value("root_rotation_err_deg"), 0, 1e-6);
  EXPECT_EQ(e.breakdowns[1].labels, (std::vector<std::string>{"a", "c"}));
}

TEST(EvaluationHeldOutTest, RootAndScaleAreForgivenInTheOtherViewsOnly) {
  Scene scene = MakeScene();
  for (MatrixX3d& frame : scene.track.coco17) {
    frame = 0.8 * frame;  // nearer and smaller: the same picture in the fitted view
    frame.rowwise() += Eigen::RowVector3d(0.05, 0, 0);
  }
  scene.track.camera.fx *= 0.9;
  const Evaluation e = EvaluateHeldOutViews(scene.track, scene.clip, "b");
  EXPECT_NEAR(e.Value("clip_scale"), 1.25, 1e-9);
  EXPECT_NEAR(e.Value("mpjpe_scaled_mm"), 0, 1e-6);
  EXPECT_GT(e.Value("mpjpe_mm"), 20);
  EXPECT_NEAR(e.Value("heldout_p95_px"), 0, 1e-3);
  EXPECT_GT(e.Value("fitview_median_px"), 10);
  EXPECT_GT(std::abs(e.Value("fitview_own_median_px") - e.Value("fitview_median_px")), 1);
  EXPECT_GT(e.Value("root_depth_err_mm"), 500);
}

// Turning everything about the viewing axis by ten degrees is a similarity: PA-MPJPE forgives it, the angles do not.
TEST(EvaluationHeldOutTest, AWrongOrientationShows) {
  Scene scene = MakeScene();
  const Eigen::Matrix3d turn = RotationFromAxisAngle({0, 0.1, 0});
  for (int t = 0; t < kFrames; ++t) {
    const Eigen::RowVector3d hip = scene.track.coco17[t].middleRows(11, 2).colwise().mean();
    scene.track.coco17[t] = ((scene.track.coco17[t].rowwise() - hip) * turn.transpose()).rowwise() + hip;
    const Eigen::Matrix3d root = RotationFromAxisAngle(scene.track.motion.poses.row(t).head<3>().transpose());
    scene.track.motion.poses.row(t).head<3>() = AxisAngleFromRotation(turn * root).transpose();
  }
  const Evaluation e = EvaluateHeldOutViews(scene.track, scene.clip, "b");
  EXPECT_NEAR(e.Value("pa_mpjpe_mm"), 0, 1e-9);
  EXPECT_GT(e.Value("mpjpe_scaled_mm"), 5);
  EXPECT_GT(e.Value("heldout_median_px"), 2);
  EXPECT_NEAR(e.Value("root_rotation_err_deg"), 0.1 * 180 / M_PI, 1e-6);
  EXPECT_NEAR(e.Value("joint_angle_err_deg"), 0, 1e-6);
}

TEST(EvaluationHeldOutTest, LeavingOutFramesCosts) {
  Scene scene = MakeScene();
  scene.track.coco17[4](3, 1) = NAN;
  scene.track.coco17[5].setConstant(NAN);
  const Evaluation e = EvaluateHeldOutViews(scene.track, scene.clip, "b");
  EXPECT_EQ(e.frames_without_result, 2);
  EXPECT_EQ(e.frames, kFrames);
  EXPECT_GT(e.Value("pa_mpjpe_mm"), 0.1);
  EXPECT_NEAR(e.Value("root_err_mm"), 2 * 30.0 / kFrames, 0.5);  // 30 mm a frame, and the hips of the nearest frame
  for (MatrixX3d& frame : scene.track.coco17) frame.setConstant(NAN);
  EXPECT_TRUE(EvaluateHeldOutViews(scene.track, scene.clip, "b").values.empty());
}

TEST(EvaluationHeldOutTest, UnknownReferenceFramesAreLeftOut) {
  Scene scene = MakeScene();
  scene.clip.coco17_in_world[2].setConstant(NAN);
  scene.clip.motion = {};
  const Evaluation e = EvaluateHeldOutViews(scene.track, scene.clip, "b");
  EXPECT_NEAR(e.Value("pa_mpjpe_mm"), 0, 1e-9);
  EXPECT_NEAR(e.Value("heldout_p95_px"), 0, 1e-3);
  EXPECT_EQ(e.Value("heldout_not_projected"), 2 * 17);
  EXPECT_THROW(static_cast<void>(e.Value("joint_angle_err_deg")), std::invalid_argument);
}

TEST(EvaluationHeldOutTest, LowConfidenceDetectionsDoNotCount) {
  Scene scene = MakeScene();
  for (int t = 0; t < kFrames; ++t) {
    Keypoint& wrist = scene.clip.views[0].detections.at(t, 9);
    wrist = {wrist.x + 500, wrist.y, 0.3F};
  }
  EXPECT_NEAR(EvaluateHeldOutViews(scene.track, scene.clip, "b").Value("heldout_p95_px"), 0, 1e-3);
  EvaluateHeldOutViewsOptions options;
  options.min_confidence = 0.1;
  const Evaluation e = EvaluateHeldOutViews(scene.track, scene.clip, "b", options);
  EXPECT_NEAR(e.Value("heldout_pck_box_10"), 33.0 / 34, 1e-9);
}

TEST(EvaluationHeldOutTest, BrokenContractsThrow) {
  Scene scene = MakeScene();
  EXPECT_THROW(EvaluateHeldOutViews(scene.track, scene.clip, "z"), std::invalid_argument);
  EXPECT_THROW(EvaluateHeldOutViews({}, scene.clip, "b"), std::invalid_argument);
  scene.clip.views[2].detections.names.pop_back();
  EXPECT_THROW(EvaluateHeldOutViews(scene.track, scene.clip, "b"), std::invalid_argument);
}

TEST(EvaluationTriangulationTest, PointsComeBackThroughDistortion) {
  const Scene scene = MakeScene();
  int checked = 0;
  for (int t = 0; t < kFrames; ++t) {
    for (int k = 0; k < 17; ++k) {
      std::vector<Sighting> sightings;
      for (const RigView& view : scene.clip.views) {
        const Keypoint& p = view.detections.at(t, k);
        sightings.push_back({&view.camera, &view.pose, {p.x, p.y}});
      }
      const TriangulatedPoint point = TriangulatePoint(sightings);
      ASSERT_TRUE(point.is_valid);
      EXPECT_LT((point.point_in_world.transpose() - scene.clip.coco17_in_world[t].row(k)).norm(), 1e-6);
      EXPECT_LT(point.rms_px, 1e-3);
      ++checked;
    }
  }
  EXPECT_EQ(checked, 17 * kFrames);
}

TEST(EvaluationTriangulationTest, NoisyPixelsGiveTheLeastSquaresPoint) {
  const Scene scene = MakeScene();
  std::mt19937 rng(5);
  std::normal_distribution<double> noise(0, 5);
  std::vector<Sighting> sightings;
  for (const RigView& view : scene.clip.views) {
    const Keypoint& p = view.detections.at(0, 5);
    sightings.push_back({&view.camera, &view.pose, {p.x + noise(rng), p.y + noise(rng)}});
  }
  const TriangulatedPoint best = TriangulatePoint(sightings);
  ASSERT_TRUE(best.is_valid);
  EXPECT_GT(best.rms_px, 0.5);
  std::normal_distribution<double> step(0, 1e-3);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Vector3d X = best.point_in_world + Eigen::Vector3d{step(rng), step(rng), step(rng)};
    double squares = 0;
    for (const Sighting& s : sightings) {
      Eigen::Vector2d pixel;
      ASSERT_TRUE(
          s.camera->Project(s.pose->camera_from_world_rotation * X + s.pose->camera_from_world_translation, &pixel));
      squares += (pixel - s.pixel).squaredNorm();
    }
    EXPECT_GE(std::sqrt(squares / 3), best.rms_px);
  }
}

TEST(EvaluationTriangulationTest, OneRayParallelRaysAndPointsBehindAreRefused) {
  const Camera camera = MakePinhole(640, 480, 500);
  CameraPose left, right;
  right.camera_from_world_translation = Eigen::Vector3d(-1, 0, 0);
  const Eigen::Vector2d centre(319.5, 239.5);
  const auto triangulate = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return TriangulatePoint(std::vector<Sighting>{{&camera, &left, a}, {&camera, &right, b}});
  };
  EXPECT_FALSE(TriangulatePoint(std::vector<Sighting>{{&camera, &left, centre}}).is_valid);
  EXPECT_FALSE(TriangulatePoint({}).is_valid);
  EXPECT_FALSE(triangulate(centre, centre).is_valid);
  EXPECT_FALSE(triangulate(centre, centre + Eigen::Vector2d(100, 0)).is_valid);  // the rays meet behind
  const TriangulatedPoint good = triangulate(centre, centre - Eigen::Vector2d(100, 0));
  ASSERT_TRUE(good.is_valid);
  EXPECT_LT((good.point_in_world - Eigen::Vector3d(0, 0, 5)).norm(), 1e-9);
}

}  // namespace
}  // namespace bodyloom::evaluation_held_out_test
