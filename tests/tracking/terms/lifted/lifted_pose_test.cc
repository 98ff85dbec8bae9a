// SPDX-License-Identifier: Apache-2.0
// The lifter's term of the frame cost against automatic differentiation of its formula.
#include "tracking/terms/lifted/lifted_pose.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "tests/support/frame_scene.h"
#include "tests/tracking/jet_twin.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/problem/robust.h"

namespace bodyloom::lifted_pose_test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using twin::Jet;

struct Scene : FrameScene {
  LiftedLandmarks landmarks;
  LiftedPose lifted;
};

/// A random pose and a lifter that predicts another.
std::unique_ptr<Scene> MakeScene(CameraKnowledge knowledge, double pose_size, uint64_t seed,
                                 std::vector<int> active = {}) {
  auto scene = std::make_unique<Scene>();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  if (active.empty()) active = AllJoints(scene->body);
  PlaceCamera(knowledge, MakePinhole(1280, 720, 1000), 1100, active, &random, scene.get());
  PoseAtRandom(knowledge, pose_size, &random, scene.get());
  scene->landmarks = CompileLiftedLandmarks(scene->body, scene->body.num_betas());
  LiftedFrame frame;
  frame.camera_from_virtual = RotationFromAxisAngle(RandomTurn(0.3, &random));
  frame.points = MatrixX3d::NullaryExpr(kLifterPoints, 3, [&]() { return 0.4 * normal(random); });
  frame.sigma.resize(kLifterPoints, 2);
  for (int k = 0; k < kLifterPoints; ++k) {
    frame.sigma(k, 0) = 0.1 + 0.05 * std::abs(normal(random));
    frame.sigma(k, 1) = 0.2 + 0.1 * std::abs(normal(random));
  }
  scene->lifted = MakeLiftedPose(frame, scene->landmarks, 1.3, 0.03);
  scene->data.Get<LiftedPoseTerm>().pose = &scene->lifted;
  scene->data.Get<LiftedPoseTerm>().weight = 0.7;
  scene->data.Get<LiftedPoseTerm>().kernel = 4;
  return scene;
}

void CheckAgainstTwin(const Scene& scene) {
  const int p = scene.layout.num_columns, n = static_cast<int>(scene.lifted.points.size());
  MatrixXd J(3 * n, p);
  VectorXd r(3 * n);
  double cost = 0;
  for (int column = 0; column < p; ++column) {
    const twin::SeededFrame seeded =
        twin::SeedFrame(scene.body, scene.layout, scene.state, scene.betas, scene.log_focal, column);
    const auto landmark_at = [&](int k) {
      const Landmark& landmark = scene.body.data().landmarks[scene.body.FindLandmark(LifterPointNames()[k])];
      const auto vertices = seeded.body.Vertices(landmark.vertices);
      twin::Vector3<Jet> x = twin::Vector3<Jet>::Zero();
      for (size_t i = 0; i < vertices.size(); ++i) x += vertices[i] * Jet(landmark.weights[i]);
      return x;
    };
    const twin::Vector3<Jet> hips = (landmark_at(kLifterLeftHip) + landmark_at(kLifterLeftHip + 1)) * Jet(0.5);
    cost = 0;
    for (int i = 0; i < n; ++i) {
      const LiftedPose::Point& point = scene.lifted.points[i];
      const twin::Vector3<Jet> d = landmark_at(point.landmark) - hips - point.offset.cast<Jet>();
      const twin::Vector3<Jet> whitened = scene.lifted.Whitening(point).cast<Jet>() * d;
      Vector3d value, slope;
      for (int c = 0; c < 3; ++c) {
        value[c] = whitened[c].a;
        slope[c] = whitened[c].v[0];
      }
      const RobustValue robust = GemanMcClure(value.squaredNorm(), scene.data.Get<LiftedPoseTerm>().kernel);
      cost += 0.5 * scene.data.Get<LiftedPoseTerm>().weight * robust.rho;
      const double scale = std::sqrt(scene.data.Get<LiftedPoseTerm>().weight * robust.weight);
      r.segment<3>(3 * i) = scale * value;
      J.block<3, 1>(3 * i, column) = scale * slope;
    }
  }
  ASSERT_GT(cost, 0);
  ExpectMatchesTwin(Evaluate(scene), cost, J, r);
}

TEST(LiftedPose, DerivativesMatchTheTwinInEveryCamera) {
  for (const CameraKnowledge knowledge :
       {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    for (const double size : {0.1, 0.8, 2.0}) CheckAgainstTwin(*MakeScene(knowledge, size, 31));
  }
}

TEST(LiftedPose, HeldJointsHaveNoColumns) {
  CheckAgainstTwin(*MakeScene(CameraKnowledge::kKnown, 0.5, 32, {0, 1, 16}));
}

TEST(LiftedPose, CostsNothingWhereTheLifterIsRight) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.6, 33);
  const BodyPose pose{scene->state.rotations, scene->state.translation};
  const MatrixX3d truth = PoseLandmarks(scene->body, scene->betas, pose, LifterPointNames());
  const Eigen::RowVector3d hips = 0.5 * (truth.row(kLifterLeftHip) + truth.row(kLifterLeftHip + 1));
  for (LiftedPose::Point& point : scene->lifted.points) {
    point.offset = (truth.row(point.landmark) - hips).transpose();
  }
  const FrameSystem system = Evaluate(*scene);
  EXPECT_LT(system.cost, 1e-18);
  EXPECT_LT(system.gradient.norm(), 1e-8);
}

TEST(LiftedPose, SigmaIsFlooredAndTurnsWithTheView) {
  const BodyModel body{ToyBodyData()};
  const LiftedLandmarks landmarks = CompileLiftedLandmarks(body, 0);
  EXPECT_TRUE(landmarks.IsUsable());
  LiftedFrame frame;
  frame.camera_from_virtual = RotationFromAxisAngle(Vector3d(0.2, -0.5, 0.1));
  frame.points = MatrixX3d::Constant(kLifterPoints, 3, 0.1);
  frame.sigma.resize(kLifterPoints, 2);
  frame.sigma.col(0).setConstant(0.001);
  frame.sigma.col(1).setConstant(0.2);
  const LiftedPose pose = MakeLiftedPose(frame, landmarks, 1.5, 0.03);
  ASSERT_EQ(pose.points.size(), size_t{kLifterPoints});
  const Eigen::Vector3d along = frame.camera_from_virtual.col(2), across = frame.camera_from_virtual.col(0);
  EXPECT_NEAR((pose.Whitening(pose.points[4]) * along).norm(), 1 / (1.5 * 0.2), 1e-12);
  EXPECT_NEAR((pose.Whitening(pose.points[4]) * across).norm(), 1 / 0.03, 1e-9);
}

}  // namespace
}  // namespace bodyloom::lifted_pose_test
