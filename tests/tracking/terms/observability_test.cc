// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/observability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/hand_skeleton.h"

namespace bodyloom::observability_test {
namespace {

ObservedLandmarks Seen(const BodyModel& body, const std::vector<std::string>& names) {
  KeypointSequence keypoints;
  keypoints.names = names;
  return FindObservedLandmarks(body, &keypoints, 0);
}

bool Has(const BodyModel& body, const std::vector<int>& joints, const std::string& name) {
  return std::find(joints.begin(), joints.end(), body.FindJoint(name)) != joints.end();
}

TEST(Observability, DenseKeypointsDetermineAllJointsButFingers) {
  const std::vector<std::string> body_points = {"left_wrist", "right_wrist", "left_knee"};
  const BodyModel &hands = BuiltinBodyWithHands(), &without = BuiltinBody();
  EXPECT_EQ(FindActiveJoints(without, Seen(without, body_points), true, true, false).size(), 24U);
  EXPECT_EQ(FindActiveJoints(hands, Seen(hands, body_points), true, true, false).size(), 22U);
  EXPECT_EQ(FindActiveJoints(hands, Seen(hands, body_points), true, false, false).size(), 52U);
}

TEST(Observability, LandmarksOfAHandDetermineItsFingers) {
  const BodyModel& body = BuiltinBodyWithHands();
  const auto& left = HandLandmarkNames(HandSide::kLeft);
  for (const bool dense : {false, true}) {
    const std::vector<int> active = FindActiveJoints(body, Seen(body, {left.begin(), left.end()}), dense, true, false);
    for (const char* seen : {"l_index1", "l_middle1", "l_middle2", "l_pinky1", "l_ring1", "l_thumb1", "l_wrist"}) {
      EXPECT_TRUE(Has(body, active, seen)) << seen;
    }
    for (const std::string& other : HandJointNames(HandSide::kRight)) EXPECT_FALSE(Has(body, active, other)) << other;
    EXPECT_EQ(Has(body, active, "r_hip"), dense);
  }
}

}  // namespace
}  // namespace bodyloom::observability_test
