// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include "data_tools/export/export_scene.h"
#include "data_tools/export/vmc_sender.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/export/osc_twin.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::vmc_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

const double kHalf = std::sqrt(0.5);

BodyPose TPose() {
  BodyPose pose;
  pose.rotations.assign(24, Matrix3d::Identity());
  return pose;
}

std::map<std::string, VmcBone> ByName(const std::vector<VmcBone>& bones) {
  std::map<std::string, VmcBone> named;
  for (const VmcBone& bone : bones) named[bone.name] = bone;
  EXPECT_EQ(named.size(), bones.size());
  return named;
}

/// x y z w.
void ExpectQuaternion(const Quaterniond& q, double x, double y, double z, double w) {
  EXPECT_LT((q.coeffs() - Eigen::Vector4d(x, y, z, w)).norm(), 1e-12) << q.coeffs().transpose();
}

TEST(VmcBones, OfTPoseAreNotTurnedAndLieOnTheirSides) {
  const MatrixX3d rest = ToyBody().RestJoints(Eigen::VectorXd());
  const auto bones = ByName(VmcBones(ToyBody(), rest, TPose(), Vector3d::Zero()));
  for (const char* name :
       {"Hips",          "Spine",         "Chest",         "UpperChest",   "Neck",          "Head",
        "LeftUpperLeg",  "LeftLowerLeg",  "LeftFoot",      "LeftToes",     "RightUpperLeg", "RightLowerLeg",
        "RightFoot",     "RightToes",     "LeftShoulder",  "LeftUpperArm", "LeftLowerArm",  "LeftHand",
        "RightShoulder", "RightUpperArm", "RightLowerArm", "RightHand"}) {
    ASSERT_TRUE(bones.contains(name)) << name;
    ExpectQuaternion(bones.at(name).rotation, 0, 0, 0, 1);
  }
  EXPECT_EQ(bones.size(), 22u);
  // A figure that looks along z has its left at −x in Unity.
  EXPECT_LT(bones.at("LeftUpperLeg").position.x(), -0.05);
  EXPECT_GT(bones.at("RightLowerArm").position.x(), 0.1);
  EXPECT_GT(bones.at("Head").position.y(), 0.05);
  EXPECT_EQ(bones.at("LeftLowerLeg").position, UnityPosition((rest.row(4) - rest.row(1)).transpose()));
}

TEST(VmcBones, TurnsAsUnitysAxesHaveThem) {
  // The left elbow of a T-pose bends forwards by a right angle: about −y here, as the arm points along x and is to
  // point along z. In Unity it is a turn about +y: Quaternion.Euler(0, 90, 0) takes (−1, 0, 0) to (0, 0, 1).
  BodyPose pose = TPose();
  pose.rotations[18] = RotationFromAxisAngle({0, -M_PI / 2, 0});
  ASSERT_LT((pose.rotations[18] * Vector3d::UnitX() - Vector3d::UnitZ()).norm(), 1e-12);
  // The trunk leans forwards by a right angle: about +x in both.
  pose.rotations[3] = RotationFromAxisAngle({M_PI / 2, 0, 0});
  // The whole body turns to its left, about +y here and −y in Unity, and stands at (2, 1, −3).
  const MatrixX3d rest = ToyBody().RestJoints(Eigen::VectorXd());
  pose.rotations[0] = RotationFromAxisAngle({0, M_PI / 2, 0});
  pose.trans = Vector3d(2, 1, -3) - rest.row(0).transpose();
  const auto bones = ByName(VmcBones(ToyBody(), rest, pose, {0.5, 0, -1}));
  ExpectQuaternion(bones.at("LeftLowerArm").rotation, 0, kHalf, 0, kHalf);
  ExpectQuaternion(bones.at("Spine").rotation, kHalf, 0, 0, kHalf);
  ExpectQuaternion(bones.at("Hips").rotation, 0, -kHalf, 0, kHalf);
  EXPECT_LT((bones.at("Hips").position - Vector3d(-1.5, 1, -2)).norm(), 1e-12);
  EXPECT_LT((bones.at("Hips").rotation * Vector3d::UnitZ() - Vector3d(-1, 0, 0)).norm(), 1e-12);
}

TEST(VmcBones, ChainedAsUnityChainsThemAreTheJointsMirrored) {
  const std::map<std::string, std::string> parents = {{"Spine", "Hips"},
                                                      {"Chest", "Spine"},
                                                      {"UpperChest", "Chest"},
                                                      {"Neck", "UpperChest"},
                                                      {"Head", "Neck"},
                                                      {"LeftShoulder", "UpperChest"},
                                                      {"LeftUpperArm", "LeftShoulder"},
                                                      {"LeftLowerArm", "LeftUpperArm"},
                                                      {"LeftHand", "LeftLowerArm"},
                                                      {"RightUpperLeg", "Hips"},
                                                      {"RightLowerLeg", "RightUpperLeg"},
                                                      {"RightFoot", "RightLowerLeg"},
                                                      {"RightToes", "RightFoot"}};
  const MatrixX3d rest = ToyBody().RestJoints(Eigen::VectorXd::Constant(6, 0.5));
  const BodyPose pose = RandomPose(ToyBody(), 7, 1.2, 3);
  const MatrixX3d joints = PoseSkeleton(ToyBody(), rest, pose).joints;
  const auto bones = ByName(VmcBones(ToyBody(), rest, pose, Vector3d::Zero()));
  const std::function<Eigen::Isometry3d(const std::string&)> world = [&](const std::string& name) {
    const Eigen::Isometry3d local = Eigen::Translation3d(bones.at(name).position) * bones.at(name).rotation;
    return name == "Hips" ? local : Eigen::Isometry3d(world(parents.at(name)) * local);
  };
  for (const auto& [name, joint] : {std::pair{"Head", 15}, {"LeftHand", 20}, {"RightToes", 11}}) {
    EXPECT_LT((world(name).translation() - UnityPosition(joints.row(joint).transpose())).norm(), 1e-9) << name;
  }
  EXPECT_THROW(VmcBones(ToyBody(), rest.topRows(3), pose, Vector3d::Zero()), std::invalid_argument);
}

TEST(VmcSender, IsReceivedByAPlainSocket) {
  const UdpReceiver receiver;
  {
    VmcSender sender(receiver.address());
    receiver.Receive();  // that somebody is here
    const MatrixX3d rest = ToyBody().RestJoints(Eigen::VectorXd());
    const std::vector<VmcBone> bones = VmcBones(ToyBody(), rest, RandomPose(ToyBody(), 3, 1, 3), Vector3d::Zero());
    sender.Send(1.5, true, bones);
    std::vector<size_t> sizes;
    const std::vector<OscMessage> messages = receiver.Receive(&sizes);
    ASSERT_EQ(messages.size(), 3 + bones.size());
    EXPECT_EQ(messages[0].path, "/VMC/Ext/OK");
    EXPECT_EQ(messages[0].types, ",iiii");
    EXPECT_EQ(messages[0].numbers, (std::vector<double>{1, 3, 0, 1}));
    EXPECT_EQ(messages[1].path, "/VMC/Ext/T");
    EXPECT_EQ(messages[1].numbers, std::vector<double>{1.5});
    EXPECT_EQ(messages[2].path, "/VMC/Ext/Root/Pos");
    EXPECT_EQ(messages[2].types, ",sfffffff");
    EXPECT_EQ(messages[2].strings, std::vector<std::string>{"root"});
    EXPECT_EQ(messages[2].numbers, (std::vector<double>{0, 0, 0, 0, 0, 0, 1}));
    for (size_t i = 0; i < bones.size(); ++i) {
      const OscMessage& message = messages[3 + i];
      EXPECT_EQ(message.path, "/VMC/Ext/Bone/Pos");
      EXPECT_EQ(message.strings, std::vector<std::string>{bones[i].name});
      ASSERT_EQ(message.numbers.size(), 7u);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(message.numbers[k], bones[i].position[k], 1e-6);
      for (int k = 0; k < 4; ++k) EXPECT_NEAR(message.numbers[3 + k], bones[i].rotation.coeffs()[k], 1e-6);
    }
    for (const size_t size : sizes) EXPECT_LT(size, 1400u);  // no packet is cut up on its way

    sender.Send(2, false, {});
    const std::vector<OscMessage> nobody = receiver.Receive();
    ASSERT_EQ(nobody.size(), 2u);
    EXPECT_EQ(nobody[0].numbers, (std::vector<double>{1, 3, 0, 0}));
  }
}

TEST(VmcSender, IsNotStoppedByAReceiverThatIsGone) {
  std::string address;
  {
    const UdpReceiver receiver;
    address = receiver.address();
  }
  VmcSender sender(address);
  for (int i = 0; i < 5; ++i) sender.Send(i, false, {});
}

TEST(VmcSender, RefusesAWrongAddress) {
  EXPECT_THROW(VmcSender("somewhere"), std::invalid_argument);
  EXPECT_THROW(VmcSender("127.0.0.1:0"), std::invalid_argument);
  EXPECT_THAT([] { VmcSender("no-such-host.invalid:39539"); },
              testing::ThrowsMessage<std::runtime_error>(testing::StartsWith("no-such-host.invalid:39539: ")));
}

}  // namespace
}  // namespace bodyloom::vmc_test
