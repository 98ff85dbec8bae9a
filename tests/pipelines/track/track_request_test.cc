// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/base/callbacks.h"

namespace bodyloom::track_request_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TrackRequest Complete() {
  TrackRequest request;
  request.detections = "clip.json";
  request.out = "track.npz";
  return request;
}

TEST(TrackRequest, DetectionsAndAPlaceForTheTrackAreEnough) { EXPECT_NO_THROW(CheckTrackRequest(Complete())); }

TEST(TrackRequest, WhatIsMissingOrContradictsIsNamed) {
  EXPECT_THAT([] { CheckTrackRequest({}); }, ThrowsMessage<RequestError>(HasSubstr("--video is required")));
  TrackRequest request = Complete();
  request.out.clear();
  EXPECT_THAT([&] { CheckTrackRequest(request); }, ThrowsMessage<RequestError>(HasSubstr("--out is required")));
  request.plan = true;
  EXPECT_NO_THROW(CheckTrackRequest(request));
  request = Complete();
  request.live_lag = 4;
  request.solve.solver = SequenceSolver::kCeres;
  EXPECT_THAT([&] { CheckTrackRequest(request); }, ThrowsMessage<RequestError>(HasSubstr("--live")));
}

TEST(TrackRequest, APathIsOfACameraWithAPlaceAndOfAWholeClip) {
  TrackRequest request = Complete();
  request.camera_path = "sparse/0";
  request.camera_scale_m = 2;
  EXPECT_NO_THROW(CheckTrackRequest(request));
  TrackRequest weak = request;
  weak.camera = "weak";
  EXPECT_THROW(CheckTrackRequest(weak), RequestError);
  TrackRequest live = request;
  live.live_lag = 4;
  EXPECT_THROW(CheckTrackRequest(live), RequestError);
  request.camera_path = "";
  EXPECT_THROW(CheckTrackRequest(request), RequestError);
}

TEST(TrackRequest, AStatureNeedsAShapeAndAWholeClip) {
  TrackRequest request = Complete();
  request.stature_m = 1.6;
  EXPECT_NO_THROW(CheckTrackRequest(request));
  request.live_lag = 4;
  EXPECT_THAT([&] { CheckTrackRequest(request); }, ThrowsMessage<RequestError>(HasSubstr("--stature")));
  request.live_lag.reset();
  request.solve.estimate_shape = false;
  EXPECT_THAT([&] { CheckTrackRequest(request); }, ThrowsMessage<RequestError>(HasSubstr("--no-shape")));
}

TEST(TrackRequest, AVideoAloneIsDetected) {
  TrackRequest request;
  request.video = "clip.mp4";
  request.out = "track.npz";
  request.from_s = 1;
  EXPECT_NO_THROW(CheckTrackRequest(request));
  EXPECT_TRUE(DetectsPeople(request));
  request.plan = true;
  EXPECT_THAT([&] { CheckTrackRequest(request); }, ThrowsMessage<RequestError>(HasSubstr("--plan needs detections")));
  request.plan = false;
  request.detections = "clip.json";
  EXPECT_FALSE(DetectsPeople(request));
  EXPECT_NO_THROW(CheckTrackRequest(request)) << "--from of the detections";
}

TEST(TrackRequest, KneesAreKeptStraightForBlazePosesJoints) {
  TrackRequest request = Complete();
  EXPECT_EQ(StraightKneesWeight(request, "coco17"), kStraightKnees);
  EXPECT_EQ(StraightKneesWeight(request, "body25"), kStraightKnees);
  EXPECT_EQ(StraightKneesWeight(request, ""), kStraightKnees);
  EXPECT_EQ(StraightKneesWeight(request, "mediapipe33"), kBlazePoseStraightKnees);
  request.straight_knees = 0;
  EXPECT_EQ(StraightKneesWeight(request, "mediapipe33"), 0);
  request.straight_knees = 1.5;
  EXPECT_EQ(StraightKneesWeight(request, "coco17"), 1.5);
}

TEST(TrackRequest, IntrinsicsMakeAPinhole) {
  TrackRequest request = Complete();
  EXPECT_EQ(CameraKnowledgeOf(request), CameraKnowledge::kUnknownFocal);
  request.focal_px = 900;
  EXPECT_EQ(CameraKnowledgeOf(request), CameraKnowledge::kKnown);
  request.camera = "weak";
  EXPECT_EQ(CameraKnowledgeOf(request), CameraKnowledge::kWeak);
}

}  // namespace
}  // namespace bodyloom::track_request_test
