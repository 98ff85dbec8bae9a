// SPDX-License-Identifier: Apache-2.0
#include "tracking/builtin_models.h"

#include <gtest/gtest.h>

#include <memory>

#include "data_tools/body/builtin_body.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "tracking/lifter/lift_keypoints.h"

namespace bodyloom::builtin_models_test {
namespace {

TEST(WithBuiltins, FillsInWhatTheInputDoesNotName) {
  TrackSequenceInput input;
  input.camera.width = 640;
  const TrackSequenceInput all = WithBuiltins(input);
  EXPECT_EQ(all.body, &BuiltinBody());
  EXPECT_EQ(all.prior, &BuiltinPosePrior());
  EXPECT_EQ(all.lifter, &BuiltinLifter());
  EXPECT_EQ(all.camera.width, 640);
  LiveTrackerInput live;
  live.landmarks = {"nose"};
  const LiveTrackerInput live_all = WithBuiltins(live);
  EXPECT_EQ(live_all.body, &BuiltinBody());
  EXPECT_EQ(live_all.prior, &BuiltinPosePrior());
  EXPECT_EQ(live_all.lifter, &BuiltinLifter());
  EXPECT_EQ(live_all.landmarks, live.landmarks);
}

TEST(WithBuiltins, LeavesWhatItNames) {
  // Copies: objects other than the built-in ones.
  const auto body = std::make_unique<const BodyModel>(BuiltinBody());
  const auto prior = std::make_unique<const PosePrior>(BuiltinPosePrior());
  const auto lifter = std::make_unique<const LifterWeights>(BuiltinLifter());
  TrackSequenceInput input;
  input.body = body.get();
  input.prior = prior.get();
  input.lifter = lifter.get();
  const TrackSequenceInput same = WithBuiltins(input);
  EXPECT_EQ(same.body, body.get());
  EXPECT_EQ(same.prior, prior.get());
  EXPECT_EQ(same.lifter, lifter.get());
}

TEST(WithBuiltins, AnothersLandmarksTakeTheLiftersPlace) {
  const std::vector<LiftedFrame> lifted(3);
  TrackSequenceInput input;
  input.lifted = &lifted;
  EXPECT_EQ(WithBuiltins(input).lifter, nullptr);
  EXPECT_EQ(WithBuiltins(input).prior, &BuiltinPosePrior());
}

}  // namespace
}  // namespace bodyloom::builtin_models_test
