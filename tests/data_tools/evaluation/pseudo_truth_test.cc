// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/aist_evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/vertex_errors.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::pseudo_truth_test {
namespace {

using Eigen::Vector3d;

constexpr int kFrames = 24;
/// Weights of landmarks sum to one to the rounding of float32, in which a body holds them: a landmark does not move
/// with its body to more than 6e-8 of the way.
constexpr double kWeightRounding = 6e-8;

const BodyModel& Body() {
  static const std::shared_ptr<const BodyModel> body = BodyOrBuiltin("");
  return *body;
}

/// A person of this shape who moves in the world, `scale` times as large, seen by one camera that stands aslant.
struct Recording {
  MultiViewClip clip;
  std::vector<MatrixX3d> vertices_in_camera;  ///< metres of the world
};

Recording Record(const Eigen::VectorXd& betas, double scale) {
  Recording result;
  MultiViewClip& clip = result.clip;
  clip.name = "made";
  clip.fps = 60;
  clip.motion_scale = scale;
  RigView view;
  view.name = "c01";
  view.camera = MakePinhole(1920, 1080, 1500);
  view.pose.camera_from_world_rotation =
      RotationFromAxisAngle(Vector3d(0.2, -0.4, 0.1)) * RotationFromAxisAngle(Vector3d(M_PI, 0, 0));
  view.pose.camera_from_world_translation = Vector3d(0.1, 0.9, 4.2);
  view.detections.names = CocoNames();
  clip.motion.body = "smpl";
  clip.motion.poses.resize(kFrames, 72);
  clip.motion.trans.resize(kFrames, 3);
  const Eigen::VectorXd a = RandomAxisAngle(Body(), 1, 0.5), b = RandomAxisAngle(Body(), 2, 0.5);
  for (int t = 0; t < kFrames; ++t) {
    clip.motion.poses.row(t) = (a + (b - a) * t / kFrames).transpose();
    view.detections.timestamps.push_back(t / clip.fps);
    clip.motion.trans.row(t) << 0.3 + 0.02 * t, 0.9, -0.2;
    const BodyPose pose =
        PoseFromAxisAngle(Body(), clip.motion.poses.row(t).transpose(), clip.motion.trans.row(t).transpose());
    clip.coco17_in_world.emplace_back(scale * PoseLandmarks(Body(), betas, pose, CocoNames()));
    const MatrixX3d world = scale * PoseVertices(Body(), betas, pose);
    result.vertices_in_camera.emplace_back((world * view.pose.camera_from_world_rotation.transpose()).rowwise() +
                                           view.pose.camera_from_world_translation.transpose());
  }
  view.detections.points.resize(17 * kFrames);  // nothing is seen
  clip.views.push_back(view);
  return result;
}

MatrixX3d Vertices(const Track& track, int t) {
  return PoseVertices(
      Body(), track.motion.betas,
      PoseFromAxisAngle(Body(), track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose()));
}

TEST(PseudoTruth, AsPublishedItIsSeenWhereTheScaledBodyIs) {
  const Recording r = Record(Eigen::VectorXd::Zero(10), 0.93);
  const PseudoTruth truth = MakePseudoTruth(r.clip, r.clip.views[0], Body(), PseudoTruthShape::kAsPublished);
  ASSERT_EQ(truth.track.num_frames(), kFrames);
  EXPECT_NEAR(truth.landmark_error_m, 0, kWeightRounding);
  for (int t = 0; t < kFrames; t += 7) {
    const MatrixX2d seen = ProjectPoints(truth.track.camera, Vertices(truth.track, t));
    EXPECT_LT((seen - ProjectPoints(truth.track.camera, r.vertices_in_camera[t])).cwiseAbs().maxCoeff(), 1e-8) << t;
  }
}

TEST(PseudoTruth, FittedItHasTheShapeAndPlaceOfThePerson) {
  Eigen::VectorXd betas = Eigen::VectorXd::Zero(10);
  betas[0] = 1.4, betas[2] = -0.8;
  const Recording r = Record(betas, 1);
  const PseudoTruth truth = MakePseudoTruth(r.clip, r.clip.views[0], Body(), PseudoTruthShape::kFitted);
  EXPECT_LT(truth.landmark_error_m, 2e-3);  // what the shape's prior costs
  const double distance = (Vertices(truth.track, 5) - r.vertices_in_camera[5]).rowwise().norm().mean();
  const PseudoTruth mean =
      MakePseudoTruth(Record(Eigen::VectorXd::Zero(10), 1).clip, r.clip.views[0], Body(), PseudoTruthShape::kFitted);
  EXPECT_LT(distance, 0.01);
  EXPECT_LT(mean.track.motion.betas.norm(), 1e-6);
  EXPECT_LT(mean.landmark_error_m, kWeightRounding);
}

TEST(PseudoTruth, ClipsThatCannotBeUsedAreRefused) {
  Recording r = Record(Eigen::VectorXd::Zero(10), 1);
  MultiViewClip still = r.clip;
  still.motion = {};
  EXPECT_THROW(MakePseudoTruth(still, still.views[0], Body(), PseudoTruthShape::kFitted), std::invalid_argument);
  for (MatrixX3d& points : r.clip.coco17_in_world) points(3, 1) = NAN;
  EXPECT_THROW(MakePseudoTruth(r.clip, r.clip.views[0], Body(), PseudoTruthShape::kFitted), std::invalid_argument);
}

/// A track that stands d to the side has every vertex at f · d / z pixels, and no error when it is the truth.
TEST(PseudoTruth, ProjectionErrorOfASidestepIsItsAngle) {
  const Recording r = Record(Eigen::VectorXd::Zero(10), 1);
  Track track = MakePseudoTruth(r.clip, r.clip.views[0], Body(), PseudoTruthShape::kFitted).track;
  for (int t = 0; t < kFrames; ++t) {
    track.coco17.emplace_back(PoseLandmarks(
        Body(), track.motion.betas,
        PoseFromAxisAngle(Body(), track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose()),
        CocoNames()));
  }
  const Evaluation same = EvaluateAist(track, r.clip, "c01", &Body());
  EXPECT_NEAR(same.Value("projection_mean_px"), 0, 1e-9);
  EXPECT_NEAR(same.Value("pve_mm"), 0, 1e-9);
  constexpr double kStep_m = 0.05;
  track.motion.trans.col(0).array() += kStep_m;
  double expected = 0;
  for (int t = 0; t < kFrames; ++t) {
    expected += 1500 * kStep_m * r.vertices_in_camera[t].col(2).cwiseInverse().mean() * 512 / 1920 / kFrames;
  }
  const Evaluation aside = EvaluateAist(track, r.clip, "c01", &Body());
  EXPECT_NEAR(aside.Value("projection_mean_px"), expected, 1e-6);
  EXPECT_NEAR(aside.Value("pve_mm"), 0, 1e-9);
}

}  // namespace
}  // namespace bodyloom::pseudo_truth_test
