// SPDX-License-Identifier: Apache-2.0
/// BVH with the names of every rig, read back by an independent reader.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "data_tools/motion/bvh_writer.h"
#include "tests/data_tools/export/exported_scene.h"

namespace bodyloom::bvh_rig_test {
namespace {

using Eigen::Vector3d;

/// The world positions of a BVH file's joints at a frame, by name: a reader of the test's own.
std::map<std::string, Vector3d> BvhPositions(const std::string& text, int frame, bool at_rest = false) {
  std::istringstream stream(text);
  std::string word, name;
  struct Joint {
    std::string name;
    int parent;
    Vector3d offset;
  };
  std::vector<Joint> joints;
  std::vector<int> open;
  bool end_site = false;
  while (stream >> word && word != "MOTION") {
    if (word == "ROOT" || word == "JOINT") {
      stream >> name;
      joints.push_back({name, open.empty() ? -1 : open.back(), Vector3d::Zero()});
      end_site = false;
    } else if (word == "End") {
      end_site = true;
    } else if (word == "{") {
      open.push_back(end_site ? -2 : int(joints.size()) - 1);
    } else if (word == "}") {
      open.pop_back();
    } else if (word == "OFFSET") {
      Vector3d offset;
      stream >> offset[0] >> offset[1] >> offset[2];
      if (!end_site) joints.back().offset = offset;
    }
  }
  std::string line;
  while (std::getline(stream, line) && line.find("Frame Time") == std::string::npos) {
  }
  for (int t = 0; t <= frame; ++t) std::getline(stream, line);
  std::istringstream numbers(line);
  Vector3d root;
  numbers >> root[0] >> root[1] >> root[2];
  std::map<std::string, Vector3d> positions;
  std::vector<Eigen::Affine3d> world;
  for (const Joint& joint : joints) {
    Vector3d zxy;
    numbers >> zxy[0] >> zxy[1] >> zxy[2];
    if (at_rest) zxy.setZero();
    const double deg = M_PI / 180;
    Eigen::Affine3d local = Eigen::Translation3d(joint.parent < 0 ? root : joint.offset) *
                            Eigen::AngleAxisd(zxy[0] * deg, Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(zxy[1] * deg, Vector3d::UnitX()) *
                            Eigen::AngleAxisd(zxy[2] * deg, Vector3d::UnitY());
    world.push_back(joint.parent < 0 ? local : world[size_t(joint.parent)] * local);
    positions[joint.name] = world.back().translation() / 100;
  }
  return positions;
}

TEST(BvhRig, JointsAreWhereTheyAreUnderEveryRigsNames) {
  const Track track = ShortTrack();
  const ExportScene scene = SceneOf(track);
  const ExportPerson& person = scene.people[0];
  const Motion motion = MotionInWorld(TiltedWorld(), person.rest_joints.row(0).transpose(), track.motion);
  const MatrixX3d truth = PoseSkeleton(BuiltinBody(), person.rest_joints, person.poses[7]).joints;
  const std::map<AnimationRig, std::vector<std::string>> wrist_ankle = {
      {AnimationRig::kSmpl, {"l_wrist", "r_ankle", "head"}},
      {AnimationRig::kMixamo, {"LeftHand", "RightFoot", "Head"}},
      {AnimationRig::kUnreal, {"hand_l", "foot_r", "head"}}};
  for (const auto& [rig, names] : wrist_ankle) {
    const std::string text = BvhText(motion, BuiltinBody(), rig);
    const std::map<std::string, Vector3d> at = BvhPositions(text, 7);
    EXPECT_EQ(at.size(), rig == AnimationRig::kSmpl ? 24U : 22U);
    EXPECT_LT((at.at(names[0]) - truth.row(20).transpose()).norm(), 1e-6);
    EXPECT_LT((at.at(names[1]) - truth.row(8).transpose()).norm(), 1e-6);
    EXPECT_LT((at.at(names[2]) - truth.row(15).transpose()).norm(), 1e-6);
    const std::map<std::string, Vector3d> rest = BvhPositions(text, 7, true);
    const std::string shoulder = rig == AnimationRig::kMixamo   ? "LeftArm"
                                 : rig == AnimationRig::kUnreal ? "upperarm_l"
                                                                : "l_shoulder";
    const Vector3d arm = rest.at(names[0]) - rest.at(shoulder);
    EXPECT_NEAR(std::atan2(-arm.y(), arm.x()) * 180 / M_PI, rig == AnimationRig::kUnreal ? 45 : 0, 3)
        << "below the horizontal";
  }
  EXPECT_THROW(AnimationRigFromString("rigify"), std::invalid_argument);
}

TEST(BvhRig, FingersAreWhereTheyAreUnderEveryRigsNames) {
  const BodyModel& body = BuiltinBodyWithHands();
  const Track track = TrackWithHands();
  const ExportScene scene = SceneOf(track, body);
  const ExportPerson& person = scene.people[0];
  const Motion motion = MotionInWorld(TiltedWorld(), person.rest_joints.row(0).transpose(), track.motion);
  const MatrixX3d truth = PoseSkeleton(body, person.rest_joints, person.poses[7]).joints;
  const std::map<AnimationRig, std::vector<std::string>> index_pinky = {
      {AnimationRig::kSmpl, {"l_index3", "r_pinky3", "r_thumb3"}},
      {AnimationRig::kMixamo, {"LeftHandIndex3", "RightHandPinky3", "RightHandThumb3"}},
      {AnimationRig::kUnreal, {"index_03_l", "pinky_03_r", "thumb_03_r"}},
      {AnimationRig::kVrm, {"leftIndexDistal", "rightLittleDistal", "rightThumbDistal"}}};
  for (const auto& [rig, names] : index_pinky) {
    const std::map<std::string, Vector3d> at = BvhPositions(BvhText(motion, body, rig), 7);
    EXPECT_EQ(at.size(), 52U);
    const std::vector<std::string> joints = {"l_index3", "r_pinky3", "r_thumb3"};
    for (size_t i = 0; i < joints.size(); ++i) {
      EXPECT_LT((at.at(names[i]) - truth.row(body.FindJoint(joints[i])).transpose()).norm(), 1e-6) << names[i];
    }
  }
}

}  // namespace
}  // namespace bodyloom::bvh_rig_test
