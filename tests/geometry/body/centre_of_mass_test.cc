// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/centre_of_mass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "tests/support/toy_body.h"

namespace bodyloom::centre_of_mass_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// All joints at the origin but those given.
MatrixX3d JointsAt(const std::vector<std::pair<std::string, Vector3d>>& places) {
  MatrixX3d joints = MatrixX3d::Zero(ToyBody().num_joints(), 3);
  for (const auto& [name, place] : places) joints.row(ToyBody().FindJoint(name)) = place.transpose();
  return joints;
}

TEST(CentreOfMass, SharesAreThoseOfOneBody) {
  double sum = 0;
  for (const SegmentMass& segment : SegmentMasses()) {
    EXPECT_GT(segment.share, 0) << segment.name;
    sum += segment.share;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  const Eigen::VectorXd mass = MassByJoint(ToyBody());
  ASSERT_EQ(mass.size(), ToyBody().num_joints());
  EXPECT_NEAR(mass.sum(), 1, 1e-12) << "moving all joints moves the centre as far";
  EXPECT_NEAR(mass[ToyBody().FindJoint("l_knee")], mass[ToyBody().FindJoint("r_knee")], 1e-15);
}

TEST(CentreOfMass, IsTheSumOfTheSegments) {
  const Eigen::VectorXd mass = MassByJoint(ToyBody());
  // A knee 1 m ahead: 38.5 % of the thigh's 14.47 %, and what is left of the shank's 4.57 % above its ankle.
  const double knee = 0.1447 * 0.385 + 0.0457 * (1 - 0.437);
  EXPECT_NEAR((CentreOfMass(JointsAt({{"l_knee", {0, 0, 1}}}), mass) - Vector3d(0, 0, knee)).norm(), 0, 1e-12);
  // The trunk between shoulders 0.5 m above hips, everything else at the hips: 59.5 % of the way up, and the ends of
  // the upper arms.
  const MatrixX3d raised = JointsAt({{"l_shoulder", {0.2, 0.5, 0}}, {"r_shoulder", {-0.2, 0.5, 0}}});
  const double height = 0.5 * (0.4302 * (1 - 0.405) + 2 * 0.0263 * (1 - 0.576));
  EXPECT_NEAR((CentreOfMass(raised, mass) - Vector3d(0, height, 0)).norm(), 0, 1e-12);
  // The neck 1 m up and the head at the origin: the head's centre is beyond the head's joint.
  EXPECT_NEAR(CentreOfMass(JointsAt({{"neck", {0, 1, 0}}}), mass).y(), 0.0681 * (1 - 1.2), 1e-12);
}

TEST(CentreOfMass, OfAStandingBodyIsAtThePelvis) {
  const MatrixX3d joints = ToyBody().joint_template();
  const Vector3d centre = CentreOfMass(joints, MassByJoint(ToyBody()));
  EXPECT_NEAR(centre.x(), 0, 0.01);
  // A standing adult's is at 55–57 % of the stature; the toy body's joints lie between sole and crown.
  const double sole = ToyBody().data().v_template.col(1).minCoeff(),
               crown = ToyBody().data().v_template.col(1).maxCoeff();
  EXPECT_NEAR((centre.y() - sole) / (crown - sole), 0.57, 0.05) << "arms are held out at the shoulders' height";
}

TEST(CentreOfMass, NeedsTheJointsOfTheTable) {
  BodyModelData data = ToyBodyData();
  data.joint_names = SmplJointNames();
  data.joint_names[4] = "somewhere";
  EXPECT_EQ(MassByJoint(BodyModel(std::move(data))).size(), 0);
  EXPECT_THROW(CentreOfMass(MatrixX3d::Zero(3, 3), MassByJoint(ToyBody())), std::invalid_argument);
}

TEST(ZeroMomentPoint, IsBelowTheCentreOfWhoIsAtRest) {
  EXPECT_EQ(ZeroMomentPoint({0.3, 1, -2}, Vector3d::Zero()), Vector2d(0.3, -2));
}

TEST(ZeroMomentPoint, IsWhereTheForceOfTheGroundPointsFrom) {
  const Vector3d c(0.3, 0.9, -2), a(1.2, 0.4, -0.7);
  const Vector2d p = ZeroMomentPoint(c, a);
  // The force a + g acts along the line from p to c.
  const Vector3d arm = c - Vector3d(p.x(), 0, p.y());
  EXPECT_NEAR(arm.cross(a + Vector3d(0, 9.81, 0)).norm(), 0, 1e-12);
  // An inverted pendulum let go: leaning by 0.2 m it accelerates by g · 0.2 / 0.9 and balances about its foot.
  EXPECT_NEAR(ZeroMomentPoint({0.2, 0.9, 0}, {9.81 * 0.2 / 0.9, 0, 0}).x(), 0, 1e-12);
}

TEST(ZeroMomentPoint, IsNowhereInFreeFall) {
  EXPECT_TRUE(ZeroMomentPoint({0, 1, 0}, {0, -9.81, 0}).array().isNaN().all());
  EXPECT_TRUE(ZeroMomentPoint({0, 1, 0}, {0, -12, 0}).array().isNaN().all());
}

}  // namespace
}  // namespace bodyloom::centre_of_mass_test
