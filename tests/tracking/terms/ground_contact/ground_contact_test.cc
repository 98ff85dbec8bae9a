// SPDX-License-Identifier: Apache-2.0
// Standing feet and the trunk's lean in the frame cost against automatic differentiation of their formulas.
#include "tracking/terms/ground_contact/ground_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "tests/support/frame_scene.h"
#include "tests/tracking/jet_twin.h"
#include "tracking/problem/robust.h"
#include "tracking/terms/upright.h"

namespace bodyloom::ground_contact_test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using twin::Jet;

constexpr const char* kFeet[] = {"left_ankle", "right_ankle"};

struct Scene : FrameScene {
  std::vector<CompiledPoint> points;
};

const Landmark& Foot(const BodyModel& body, int foot) { return body.data().landmarks[body.FindLandmark(kFeet[foot])]; }

/// A random pose with both feet held `off_m` or so from where they are.
std::unique_ptr<Scene> MakeScene(CameraKnowledge knowledge, double pose_size, double off_m, uint64_t seed,
                                 std::vector<int> active = {}) {
  auto scene = std::make_unique<Scene>();
  std::mt19937_64 random(seed);
  if (active.empty()) active = AllJoints(scene->body);
  PlaceCamera(knowledge, MakePinhole(1280, 720, 1000), 1100, active, &random, scene.get());
  PoseAtRandom(knowledge, pose_size, &random, scene.get());
  scene->points.reserve(2);
  Kinematics kinematics;
  PointEvaluator evaluator;
  kinematics.Set(scene->body, scene->betas, scene->state.rotations, Vector3d::Zero(), false);
  for (int foot = 0; foot < 2; ++foot) {
    const Landmark& landmark = Foot(scene->body, foot);
    scene->points.push_back(CompilePoint(scene->body, landmark.vertices, landmark.weights, scene->body.num_betas()));
    GroundContact contact;
    contact.point = &scene->points.back();
    contact.target_m = evaluator.Evaluate(kinematics, scene->points.back(), false) +
                       scene->layout.BodyPlace(scene->state) + RandomTurn(off_m, &random);
    contact.whitening = Vector3d(10, 20, 30).asDiagonal() * RotationFromAxisAngle(RandomTurn(1, &random));
    scene->data.Get<GroundContactTerm>().feet.push_back(contact);
  }
  return scene;
}

void CheckAgainstTwin(const Scene& scene) {
  const int p = scene.layout.num_columns;
  MatrixXd J = MatrixXd::Zero(6, p);
  VectorXd r(6);
  double cost = 0;
  for (int column = 0; column < p; ++column) {
    const twin::SeededFrame seeded =
        twin::SeedFrame(scene.body, scene.layout, scene.state, scene.betas, scene.log_focal, column);
    cost = 0;
    for (int foot = 0; foot < 2; ++foot) {
      const Landmark& landmark = Foot(scene.body, foot);
      const auto vertices = seeded.body.Vertices(landmark.vertices);
      twin::Vector3<Jet> x = twin::Vector3<Jet>::Zero();
      for (size_t i = 0; i < vertices.size(); ++i) x += vertices[i] * Jet(landmark.weights[i]);
      if (scene.layout.knowledge == CameraKnowledge::kWeak) {
        twin::Vector3<Jet> t;
        for (int c = 0; c < 3; ++c) {
          t[c] = Jet(scene.state.translation[c]);
          if (column == scene.layout.translation_column + c) t[c].v[0] = 1;
        }
        x += twin::Vector3<Jet>(t[1], t[2], Jet(scene.layout.camera.fx) / exp(t[0]));
      }
      const GroundContact& contact = scene.data.Get<GroundContactTerm>().feet[foot];
      const twin::Vector3<Jet> d = x - contact.target_m.cast<Jet>();
      const twin::Vector3<Jet> whitened = contact.whitening.cast<Jet>() * d;
      Vector3d value, slope;
      for (int c = 0; c < 3; ++c) {
        value[c] = whitened[c].a;
        slope[c] = whitened[c].v[0];
      }
      const RobustValue robust = GemanMcClure(value.squaredNorm(), kContactKernel);
      cost += 0.5 * robust.rho;
      r.segment<3>(3 * foot) = std::sqrt(robust.weight) * value;
      J.block<3, 1>(3 * foot, column) = std::sqrt(robust.weight) * slope;
    }
  }
  ASSERT_GT(cost, 0);
  ExpectMatchesTwin(Evaluate(scene), cost, J, r);
}

TEST(GroundContact, DerivativesMatchTheTwinInEveryCamera) {
  for (const CameraKnowledge knowledge :
       {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    for (const double off_m : {1e-6, 0.03, 0.3}) CheckAgainstTwin(*MakeScene(knowledge, 0.6, off_m, 41));
  }
}

TEST(GroundContact, HeldJointsHaveNoColumns) {
  CheckAgainstTwin(*MakeScene(CameraKnowledge::kKnown, 0.5, 0.05, 42, {0, 1, 4}));
}

TEST(GroundContact, CostsNothingWhereTheFootIs) {
  for (const CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kWeak}) {
    const FrameSystem system = Evaluate(*MakeScene(knowledge, 0.6, 0, 43));
    EXPECT_LT(system.cost, 1e-18);
    EXPECT_LT(system.gradient.norm(), 1e-8);
  }
}

/// ½ w ρ((n·R e_y)²/σ²) by central differences of the rotation, for verticals other than the image's.
TEST(Upright, LeanIsMeasuredAlongTheNormal) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.4, 0.1, 44);
  scene->data.Get<GroundContactTerm>().feet.clear();
  scene->data.Get<UprightTerm>().weight = 0.8;
  scene->data.Get<UprightTerm>().normal = Vector3d(0.1, 0.5, 0.9).normalized();
  const FrameSystem system = Evaluate(*scene);
  const double lean = scene->data.Get<UprightTerm>().normal.dot(scene->state.rotations[0].col(1)) / kUprightSigma;
  EXPECT_NEAR(system.cost, 0.4 * GemanMcClure(lean * lean, kUprightKernel).rho, 1e-12);
  EXPECT_GT(system.cost, 1e-3);
  const Eigen::Matrix3d R = scene->state.rotations[0];
  for (int c = 0; c < 3; ++c) {
    double cost[2];
    for (int side = 0; side < 2; ++side) {
      scene->state.rotations[0] = R * RotationFromAxisAngle((side == 0 ? 1e-6 : -1e-6) * Vector3d::Unit(c));
      cost[side] = Evaluate(*scene, false).cost;
    }
    EXPECT_NEAR(system.gradient[scene->layout.column_of_joint[0] + c], (cost[0] - cost[1]) / 2e-6, 1e-7);
  }
}

}  // namespace
}  // namespace bodyloom::ground_contact_test
