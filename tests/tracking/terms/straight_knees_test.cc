// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/straight_knees.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "geometry/math/rotation.h"
#include "tests/support/frame_scene.h"
#include "tests/tracking/jet_twin.h"

namespace bodyloom::straight_knees_test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using twin::Jet;

constexpr double kWeight = 0.7;

std::unique_ptr<FrameScene> MakeScene(std::vector<int> active = {}) {
  auto scene = std::make_unique<FrameScene>();
  std::mt19937_64 random(5);
  if (active.empty()) active = AllJoints(scene->body);
  PlaceCamera(CameraKnowledge::kKnown, MakePinhole(1280, 720, 1000), 1000, active, &random, scene.get());
  PoseAtRandom(CameraKnowledge::kKnown, 0.5, &random, scene.get());
  scene->data.Get<StraightKneesTerm>() = {FindKnees(scene->body), kWeight};
  return scene;
}

double Cost(const FrameScene& scene) { return Evaluate(scene, false).cost; }

/// The term from its formula, by automatic differentiation along right increments.
void CheckAgainstTwin(const FrameScene& scene) {
  MatrixXd J = MatrixXd::Zero(2, scene.layout.num_columns);
  VectorXd r = VectorXd::Zero(2);
  double cost = 0;
  const int knees[2] = {scene.body.FindJoint("l_knee"), scene.body.FindJoint("r_knee")};
  for (int k = 0; k < 2; ++k) {
    const double flexion = AxisAngleFromRotation(scene.state.rotations[knees[k]]).x();
    const double c2 = kStraightKneesKernel * kStraightKneesKernel, s = flexion * flexion;
    cost += 0.5 * kWeight * kWeight * c2 * s / (c2 + s);
    const double root_of_weight = kWeight * c2 / (c2 + s);  // sqrt(rho') = c² / (c² + s)
    r[k] = root_of_weight * flexion;
    for (int c = 0; c < 3; ++c) {
      twin::Vector3<Jet> step = twin::Vector3<Jet>::Zero();
      step[c].v[0] = 1;
      const twin::Matrix3<Jet> turned = scene.state.rotations[knees[k]].cast<Jet>() * twin::Exp(step);
      J(k, scene.layout.column_of_joint[knees[k]] + c) = root_of_weight * twin::Log(turned)[0].v[0];
    }
  }
  ExpectMatchesTwin(Evaluate(scene), cost, J, r);
}

TEST(StraightKnees, MatchAutomaticDerivatives) {
  const auto scene = MakeScene();
  CheckAgainstTwin(*scene);
  const int left = scene->data.Get<StraightKneesTerm>().knees[0], right = scene->data.Get<StraightKneesTerm>().knees[1];
  const auto bend = [&](const Vector3d& a, const Vector3d& b) {
    scene->state.rotations[left] = RotationFromAxisAngle(a);
    scene->state.rotations[right] = RotationFromAxisAngle(b);
    CheckAgainstTwin(*scene);
  };
  bend({0, 0.2, -0.1}, {0, 0, 0});                     // no flexion: zero residual
  bend({kStraightKneesKernel, 0, 0.1}, {-0.2, 0, 0});  // at the kernel's width; beyond straight
  bend({2.7, 0.1, -0.3}, {2.9, 0, 0});                 // a squat
}

TEST(StraightKnees, OnlyKneesCount) {
  const auto scene = MakeScene();
  const auto [left, right] = scene->data.Get<StraightKneesTerm>().knees;
  EXPECT_EQ(scene->body.data().joint_names[left], "l_knee");
  EXPECT_EQ(scene->body.data().joint_names[right], "r_knee");
  scene->state.rotations[left] = scene->state.rotations[right] = Eigen::Matrix3d::Identity();
  EXPECT_EQ(Cost(*scene), 0);
  scene->state.rotations[left] = RotationFromAxisAngle({0.3, 0, 0});
  const double one = Cost(*scene);
  EXPECT_GT(one, 0);
  scene->state.rotations[right] = scene->state.rotations[left];
  EXPECT_DOUBLE_EQ(Cost(*scene), 2 * one);
  scene->data.Get<StraightKneesTerm>().weight = 0;
  EXPECT_EQ(Cost(*scene), 0);
}

TEST(StraightKnees, AKneeThatIsBentFarIsLetGo) {
  const auto scene = MakeScene();
  const int left = scene->data.Get<StraightKneesTerm>().knees[0];
  scene->state.rotations[scene->data.Get<StraightKneesTerm>().knees[1]] = Eigen::Matrix3d::Identity();
  const auto pull = [&](double flexion) {
    scene->state.rotations[left] = RotationFromAxisAngle({flexion, 0, 0});
    return Evaluate(*scene).gradient[scene->layout.column_of_joint[left]];
  };
  EXPECT_NEAR(pull(0.01), kWeight * kWeight * 0.01, 0.002 * kWeight * kWeight * 0.01);  // quadratic near straight
  EXPECT_GT(pull(0.23), 0.1 * kWeight * kWeight);
  EXPECT_LT(pull(1.05), 0.25 * pull(0.23));
  EXPECT_LT(pull(2.0), 0.05 * pull(0.23));
}

TEST(StraightKnees, AKneeThatIsNotEstimatedHasNoPart) {
  const auto all = MakeScene();
  const auto [left, right] = all->data.Get<StraightKneesTerm>().knees;
  const auto scene = MakeScene({0, left});
  scene->state.rotations[left] = Eigen::Matrix3d::Identity();
  ASSERT_NE(AxisAngleFromRotation(scene->state.rotations[right]).x(), 0);
  EXPECT_EQ(Cost(*scene), 0);
  scene->data.Get<StraightKneesTerm>().knees = {-1, -1};
  scene->state.rotations[left] = RotationFromAxisAngle({0.3, 0, 0});
  EXPECT_EQ(Cost(*scene), 0);
}

}  // namespace
}  // namespace bodyloom::straight_knees_test
