// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/skinning.h"

#include <gtest/gtest.h>

#include "tests/support/toy_body.h"

namespace bodyloom::joint_influence_test {
namespace {

TEST(JointInfluence, StrongestIsTheLargestWeight) {
  const BodyModel& body = ToyBody();
  const std::vector<int> strongest = StrongestJoints(body);
  const Eigen::MatrixXd weights = Eigen::MatrixXd(body.data().weights);
  for (int v = 0; v < body.num_vertices(); ++v) {
    EXPECT_NEAR(weights(v, strongest[v]), weights.row(v).maxCoeff(), 1e-12) << v;
  }
}

TEST(JointInfluence, BelowTheRootIsEverythingAndBelowAWristTheHand) {
  const BodyModel& body = ToyBody();
  for (const double weight : WeightsBelow(body, {"pelvis"})) EXPECT_NEAR(weight, 1, 1e-9);
  for (const double weight : WeightsBelow(body, {"no such joint"})) EXPECT_EQ(weight, 0);
  const std::vector<double> hand = WeightsBelow(body, {"l_wrist"});
  const Eigen::MatrixXd weights = Eigen::MatrixXd(body.data().weights);
  const int wrist = body.FindJoint("l_wrist"), fingers = body.FindJoint("l_hand");
  for (int v = 0; v < body.num_vertices(); ++v) {
    EXPECT_NEAR(hand[v], weights(v, wrist) + weights(v, fingers), 1e-12) << v;
  }
}

}  // namespace
}  // namespace bodyloom::joint_influence_test
