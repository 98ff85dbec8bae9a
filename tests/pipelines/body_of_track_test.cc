// SPDX-License-Identifier: Apache-2.0
#include "pipelines/body_of_track.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "data_tools/body/builtin_body.h"

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

}  // namespace
}  // namespace bodyloom::body_of_track_test
