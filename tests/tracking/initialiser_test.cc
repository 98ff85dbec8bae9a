// SPDX-License-Identifier: Apache-2.0
// The tracker with initial poses of another system, on synthetic clips with known truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/clip/initialiser_gain.h"
#include "tracking/lifter/given_landmarks.h"
#include "tracking/lifter/lift_keypoints.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/live/track_live.h"

namespace bodyloom::initialiser_test {
namespace {

constexpr int kFrames = 40;

const SynthClip& Clip() {
  static const SynthClip clip = [] {
    SynthClipOptions options;
    options.dense_per_frame = 0;
    options.camera.elevation_deg = 8;
    options.initialiser_error_px = 14.8;
    return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), kFrames, 20), options);
  }();
  return clip;
}

TrackSequenceInput InputFrom(const Motion& initialiser) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &Clip().keypoints;
  input.prior = &BuiltinPosePrior();
  input.lifter = &BuiltinLifter();
  input.camera = Clip().truth.camera;
  input.initialiser = &initialiser;
  return input;
}

TrackSequenceOptions Known() {
  TrackSequenceOptions options;
  options.camera_knowledge = CameraKnowledge::kKnown;
  options.num_threads = 2;
  return options;
}

bool Ran(const TrackSequenceSummary& summary, const std::string& what) {
  for (const PlanEntry& entry : summary.plan) {
    if (entry.what == what) return entry.runs;
  }
  ADD_FAILURE() << "the plan does not speak of " << what;
  return false;
}

double JointErrorMm(const Track& track) {
  return 1000 * ProcrustesPositionError(track.joints, Clip().truth.joints).frames.mean;
}

void Lose(int begin, int end, Motion* motion) {
  for (int t = begin; t < end; ++t) {
    motion->poses.row(t).setConstant(std::numeric_limits<double>::quiet_NaN());
    motion->trans.row(t).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

TEST(Initialiser, FramesThatItLacksAreFilledAndFitted) {
  const TrackSequenceResult all = FitClip(InputFrom(Clip().initialiser), Known());
  Motion gaps = Clip().initialiser;
  Lose(0, 4, &gaps);
  Lose(17, 25, &gaps);
  const TrackSequenceResult some = FitClip(InputFrom(gaps), Known());
  ASSERT_TRUE(some.summary.IsUsable()) << some.summary.message;
  EXPECT_TRUE(some.track.motion.poses.allFinite());
  EXPECT_EQ(some.summary.frames_by_status.at("tracked"), kFrames);
  EXPECT_LT(JointErrorMm(some.track), 1.3 * JointErrorMm(all.track));
  LiveTrackerOptions live;
  live.solve = Known();
  const TrackSequenceResult one_by_one = TrackLive(InputFrom(gaps), live);
  ASSERT_TRUE(one_by_one.summary.IsUsable());
  EXPECT_TRUE(one_by_one.track.motion.poses.allFinite());
}

TEST(Initialiser, RefusesHalfAFrameAndNoFrame) {
  Motion broken = Clip().initialiser;
  broken.poses(3, 7) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FitClip(InputFrom(broken), Known()), std::invalid_argument);
  Motion nothing = Clip().initialiser;
  Lose(0, kFrames, &nothing);
  EXPECT_THROW(FitClip(InputFrom(nothing), Known()), std::invalid_argument);
}

// The lifter does not start, and is asked for the vertical and the feet alone.
TEST(Initialiser, TheGroundIsLookedForAllTheSame) {
  const TrackSequenceResult with = FitClip(InputFrom(Clip().initialiser), Known());
  EXPECT_FALSE(Ran(with.summary, "lifter"));
  EXPECT_TRUE(Ran(with.summary, "vertical"));
  EXPECT_TRUE(Ran(with.summary, "ground"));
  EXPECT_TRUE(with.summary.ground.has_up) << with.summary.ground.why;
  EXPECT_LT(std::acos(std::clamp(with.summary.ground.up.dot(Clip().up_in_camera), -1.0, 1.0)) * 180 / M_PI, 10);
  TrackSequenceOptions off = Known();
  off.ground = GroundOptions::Off();
  EXPECT_FALSE(FitClip(InputFrom(Clip().initialiser), off).summary.ground.has_up);
}

TEST(InitialiserGain, CountsWhatTheFitChanged) {
  Track fit = Clip().truth;
  Motion start = fit.motion;
  const double angle = 0.2;
  const int elbow = 18;  // SMPL's left elbow
  for (int t = 0; t < kFrames; ++t) {
    const Eigen::Vector3d w = start.poses.row(t).segment<3>(3 * elbow).transpose();
    const Eigen::Matrix3d turned = RotationFromAxisAngle(w) * RotationFromAxisAngle(angle * Eigen::Vector3d::UnitY());
    start.poses.row(t).segment<3>(3 * elbow) = AxisAngleFromRotation(turned).transpose();
    start.trans(t, 2) += 0.05;
  }
  Lose(10, 20, &start);
  const InitialiserGain gain = GainOverInitialiser(BuiltinBody(), &Clip().keypoints_truth, start, fit.camera, fit);
  EXPECT_EQ(gain.frames, kFrames - 10);
  EXPECT_NEAR(gain.root_mm.median, 50, 1e-6);
  EXPECT_NEAR(gain.root_mm.p95, 50, 1e-6);
  EXPECT_NEAR(gain.root_deg.p95, 0, 1e-6);
  EXPECT_NEAR(gain.rotation_deg.median, 0, 1e-6) << "one of 23 joints turned";
  EXPECT_NEAR(gain.joint_mm.median, 0, 1e-6) << "the forearm alone moved, the place apart";
  EXPECT_GT(gain.joint_mm.p95, 10);
  EXPECT_GT(gain.landmarks, 10 * (kFrames - 10));
  EXPECT_LT(gain.fit_px.p95, 0.1) << "the truth projects to the truth";
  EXPECT_GT(gain.initialiser_px.median, 1);
  EXPECT_GT(gain.initialiser_px.p95, gain.initialiser_px.median);
  const InitialiserGain blind = GainOverInitialiser(BuiltinBody(), nullptr, start, fit.camera, fit);
  EXPECT_EQ(blind.landmarks, 0);
  EXPECT_TRUE(std::isnan(blind.fit_px.median));
  start.poses.conservativeResize(kFrames - 1, Eigen::NoChange);
  EXPECT_THROW(GainOverInitialiser(BuiltinBody(), nullptr, start, fit.camera, fit), std::invalid_argument);
}

TEST(InitialiserGain, AFitIsNearerToTheImageThanItsStart) {
  const TrackSequenceResult result = FitClip(InputFrom(Clip().initialiser), Known());
  const InitialiserGain gain =
      GainOverInitialiser(BuiltinBody(), &Clip().keypoints, Clip().initialiser, Clip().truth.camera, result.track);
  EXPECT_EQ(gain.frames, kFrames);
  EXPECT_LT(gain.fit_px.median, 0.7 * gain.initialiser_px.median);
  EXPECT_GT(gain.joint_mm.median, 5);
  // The summary leaves out what the tracker takes for impossible.
  EXPECT_NEAR(gain.fit_px.median, result.summary.reprojection_median_px, 0.05);
}

/// The true landmarks that the lifter speaks of, frame by frame.
std::vector<MatrixX3d> TrueLandmarks() {
  std::vector<MatrixX3d> frames;
  const Motion& motion = Clip().truth.motion;
  for (int t = 0; t < kFrames; ++t) {
    const BodyPose pose =
        PoseFromAxisAngle(BuiltinBody(), motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
    frames.push_back(PoseLandmarks(BuiltinBody(), motion.betas, pose, LifterPointNames()));
  }
  return frames;
}

// Perfect 3D landmarks settle the depths that 2D joints leave open.
TEST(GivenLandmarks, TakeTheLiftersPlace) {
  const Motion none;
  TrackSequenceInput input = InputFrom(none);
  input.initialiser = nullptr;
  const TrackSequenceResult lifted = FitClip(input, Known());
  std::vector<LiftedFrame> frames =
      LiftKeypoints(Clip().keypoints, Clip().truth.camera, true, std::vector<char>(kFrames, 0), BuiltinLifter(), {});
  std::vector<MatrixX3d> given = TrueLandmarks();
  given[7].resize(0, 3);
  const LiftedFrame kept = frames[7];
  const Eigen::Vector3d up = frames[8].up;
  TakeGivenLandmarks(given, {}, &frames);
  EXPECT_EQ(frames[7].points, kept.points) << "a frame that was not given";
  EXPECT_EQ(frames[8].up, up) << "the vertical stays the lifter's";
  EXPECT_EQ(frames[8].limbs[2].size(), 1U);
  input.lifted = &frames;
  const TrackSequenceResult result = FitClip(input, Known());
  ASSERT_TRUE(result.summary.IsUsable()) << result.summary.message;
  EXPECT_LT(JointErrorMm(result.track), 0.8 * JointErrorMm(lifted.track));
  const InitialiserGain gain =
      GainOverLandmarks(BuiltinBody(), &Clip().keypoints_truth, TrueLandmarks(), Clip().truth.camera, Clip().truth);
  EXPECT_EQ(gain.frames, kFrames);
  EXPECT_LT(gain.joint_mm.p95, 1e-6);
  EXPECT_LT(gain.root_mm.p95, 1e-6);
  EXPECT_TRUE(std::isnan(gain.rotation_deg.median));
  EXPECT_GT(gain.landmarks, 10 * kFrames);
  EXPECT_LT(gain.initialiser_px.p95, 0.1);
  EXPECT_GT(GainOverLandmarks(BuiltinBody(), nullptr, given, Clip().truth.camera, result.track).joint_mm.median, 1);
  given.pop_back();
  EXPECT_THROW(TakeGivenLandmarks(given, {}, &frames), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::initialiser_test
