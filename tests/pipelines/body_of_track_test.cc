// SPDX-License-Identifier: Apache-2.0
#include "pipelines/body_of_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "data_tools/body/builtin_body.h"
#include "tests/support/synthetic_hands.h"

namespace bodyloom::body_of_track_test {
namespace {

TEST(BodyOfTrack, TakesTheBuiltInBodyThatTheTrackNames) {
  Track track;
  track.motion.body = BuiltinBody().name();
  EXPECT_EQ(BodyOfTrack("", track).get(), &BuiltinBody());
  track.motion.body = BuiltinBodyWithHands().name();
  EXPECT_EQ(BodyOfTrack("", track).get(), &BuiltinBodyWithHands());
  track.motion.body = "smplh";
  EXPECT_EQ(BodyOfTrack("", track).get(), &BuiltinBody()) << "whose refusal says what to give";
  EXPECT_EQ(BodyOfTrack(kBodyWithHands, track).get(), &BuiltinBodyWithHands());
  EXPECT_THROW(BodyOfTrack("no/such/body.npz", track), std::runtime_error);
}

TEST(BodyOfTrack, TakesTheOneOfSoManyJoints) {
  EXPECT_EQ(BodyOfJoints("", 24).get(), &BuiltinBody());
  EXPECT_EQ(BodyOfJoints("", 52).get(), &BuiltinBodyWithHands());
  EXPECT_EQ(BodyOfJoints("", 55).get(), &BuiltinBody()) << "whose refusal says what to give";
  EXPECT_EQ(BodyOfJoints(kBodyWithHands, 24).get(), &BuiltinBodyWithHands());
}

TEST(BodyOfTrack, ABodyWithoutFingersIsMovedByATrackThatHasThem) {
  const SyntheticHands made = MakeSyntheticHands({.pose = "fist", .frames = 3});
  const Track on_body = TrackOnBody(BuiltinBody(), made.track);
  EXPECT_EQ(on_body.motion.body, BuiltinBody().name());
  ASSERT_EQ(on_body.motion.poses.cols(), 72);
  EXPECT_EQ(on_body.motion.poses.leftCols(66), made.track.motion.poses.leftCols(66));
  EXPECT_TRUE((on_body.motion.poses.rightCols(6).array() == 0).all());
  EXPECT_EQ(on_body.joint_sigma.cols(), 24);
  for (int t = 0; t < 3; ++t) {
    EXPECT_LT((on_body.joints[size_t(t)].topRows(22) - made.track.joints[size_t(t)].topRows(22)).norm(), 1e-9);
  }
  EXPECT_EQ(TrackOnBody(BuiltinBodyWithHands(), made.track).motion.poses, made.track.motion.poses);
  EXPECT_EQ(TrackOnBody(BuiltinBody(), on_body).motion.poses, on_body.motion.poses);
  Track lost = made.track;
  lost.motion.poses.row(1).setConstant(std::nan(""));
  EXPECT_FALSE(TrackOnBody(BuiltinBody(), lost).motion.HasPose(1));
}

}  // namespace
}  // namespace bodyloom::body_of_track_test
