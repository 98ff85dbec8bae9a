// SPDX-License-Identifier: Apache-2.0
// Synthetic rigs of known truth: the built-in body in the demo motion, seen by cameras with clocks of their own.
#include "tracking/rig/track_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/synthetic_rig.h"
#include "tracking/clip/fits_progress.h"

namespace bodyloom::track_views_test {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

using Known = SyntheticRig::Known;

constexpr SyntheticCamera kFirst, kSecond = {.yaw_deg = 60, .offset_s = 0.62},
                                  kThird = {.yaw_deg = 150, .offset_s = -0.3};

/// Alone, these views have 24 to 36 mm. Two views at 50 to 90 degrees, with other clocks, with and without the ground:
/// 11 to 15 mm together, 1.8 to 2.5 times better than the better one.
void ExpectBetterThanAlone(const SyntheticRig& rig, const TrackViewsResult& result, double factor) {
  ASSERT_TRUE(result.joint.summary.IsUsable()) << result.joint.summary.message;
  for (size_t v = 0; v < rig.clips.size(); ++v) {
    EXPECT_LT(factor * rig.Joint(result), rig.Alone(result, static_cast<int>(v))) << v;
  }
  EXPECT_EQ(result.joint.summary.views.size() + 1, rig.clips.size());
  EXPECT_THAT(result.summary.used, testing::Each(1));
}

void ExpectViewFound(const SyntheticRig& rig, const TrackViewsResult& result, int v, double focal_tolerance) {
  const ViewSummary& view = result.joint.summary.views.at(v - 1);
  EXPECT_LE(rig.RotationErrorDeg(view, v), 2);
  EXPECT_LE(rig.ClockErrorFrames(view, v), 0.5);
  EXPECT_LE(std::abs(view.rate), 3e-3);
  EXPECT_NEAR(view.camera.fx / rig.clips[v].truth.camera.fx, 1, focal_tolerance);
  EXPECT_GE(view.frames, 60);
  EXPECT_LE(view.reprojection_median_px, 6);
}

TEST(TrackViews, TwoViewsOfWhichNothingIsKnown) {
  const SyntheticRig rig({kFirst, kSecond});
  const TrackViewsResult result = rig.Track(Known::kNothing);
  ExpectBetterThanAlone(rig, result, 1.7);
  ExpectViewFound(rig, result, 1, 0.1);
  ASSERT_EQ(result.summary.alignment.size(), 2U);
  EXPECT_TRUE(result.summary.alignment[1].found);
  EXPECT_EQ(result.summary.neighbour[1], 0);
  EXPECT_GE(result.summary.seconds, result.summary.seconds_alone);
}

TEST(TrackViews, IntrinsicsAreKnown) {
  const SyntheticRig rig({kFirst, kSecond});
  const TrackViewsResult result = rig.Track(Known::kIntrinsics);
  ExpectBetterThanAlone(rig, result, 1.7);
  ExpectViewFound(rig, result, 1, 0);
}

TEST(TrackViews, AllIsKnown) {
  const SyntheticRig rig({kFirst, kSecond});
  const TrackViewsResult result = rig.Track(Known::kAll);
  ExpectBetterThanAlone(rig, result, 1.7);
  const ViewSummary& view = result.joint.summary.views.at(0);
  EXPECT_LE(rig.RotationErrorDeg(view, 1), 1e-5);
  EXPECT_EQ(view.offset_s, 0.62);
  EXPECT_EQ(view.rate, 0);
  EXPECT_EQ(view.rotation_sigma_rad, 0);
  EXPECT_EQ(view.offset_sigma_s, 0);
}

/// Hands hold the cameras; their paths are given, each in a scene of its own.
TEST(TrackViews, CamerasThatMove) {
  SyntheticCamera first = kFirst, second = kSecond;
  second.motion = SynthCameraMotion::kHandHeld;
  const SyntheticRig one({first, second});
  TrackViewsResult result = one.Track(Known::kNothing);
  ExpectBetterThanAlone(one, result, 1.7);
  ExpectViewFound(one, result, 1, 0.1);

  first.motion = SynthCameraMotion::kWalking;
  const SyntheticRig both({first, second});
  result = both.Track(Known::kNothing);
  ExpectBetterThanAlone(both, result, 1.7);
  ExpectViewFound(both, result, 1, 0.1);
  ASSERT_EQ(result.joint.track.camera_from_scene.size(), both.clips[0].truth.camera_from_scene.size());

  // Without the path the second view cannot be explained.
  std::vector<ObservedView> still = one.Views(Known::kIntrinsics);
  const double with_path = SyntheticRig::Track(still).joint.summary.views.at(0).reprojection_median_px;
  still[1].camera_from_own = nullptr;
  const TrackViewsResult wrong = SyntheticRig::Track(still);
  EXPECT_TRUE(!wrong.joint.summary.IsUsable() ||
              wrong.joint.summary.views.at(0).reprojection_median_px > 1.5 * with_path);
}

/// A path whose unit is not a metre: the person tells it.
TEST(TrackViews, AMovingCameraWhosePathHasNoMetre) {
  SyntheticCamera second = kSecond;
  second.motion = SynthCameraMotion::kWalking;
  const SyntheticRig rig({kFirst, second});
  std::vector<ObservedView> views = rig.Views(Known::kIntrinsics);
  const std::vector<CameraPose> halved = ScaledPath(*views[1].camera_from_own, 0.5);
  views[1].camera_from_own = &halved;
  views[1].camera_scale_m = 0;
  const TrackViewsResult result = SyntheticRig::Track(views);
  ExpectBetterThanAlone(rig, result, 1.5);
  // The metre from one camera's feet has a standard deviation of 15 % here, and a path that is short turns the view.
  EXPECT_LE(rig.RotationErrorDeg(result.joint.summary.views.at(0), 1), 3);
}

/// Lenses of one kind: the focal length that one view tells better is the other's.
TEST(TrackViews, CamerasOfOneKind) {
  double own = 0, alike = 0;
  for (const uint64_t seed : {1, 2}) {
    std::vector<SyntheticCamera> cameras = RandomRigCameras(seed, 2, 3);
    for (SyntheticCamera& camera : cameras) camera.focal_px = 900 + 50.0 * static_cast<double>(seed);
    const SyntheticRig rig(cameras, RandomRigMotion(seed, 4), {.detector = 1, .bias_m = 0.02}, seed);
    std::vector<ObservedView> views = rig.Views(Known::kNothing);
    const auto ratio = [&](const TrackViewsResult& result) {
      return std::abs(std::log(result.joint.track.camera.fx / result.joint.summary.views.at(0).camera.fx));
    };
    own += ratio(SyntheticRig::Track(views));
    views[1].focal_ratio_log_sigma = kSameLensLogSigma;
    const TrackViewsResult result = SyntheticRig::Track(views);
    EXPECT_LE(ratio(result), 2 * kSameLensLogSigma);
    alike += ratio(result);
    // With the first one known, so is the second.
    views[0].knowledge = CameraKnowledge::kKnown;
    views[0].camera = rig.clips[0].truth.camera;
    EXPECT_NEAR(SyntheticRig::Track(views).joint.summary.views.at(0).camera.fx / rig.clips[0].truth.camera.fx, 1, 0.05);
  }
  EXPECT_LT(alike, 0.5 * own);
}

TEST(TrackViews, ThreeViews) {
  const SyntheticRig rig({kFirst, kSecond, kThird});
  const TrackViewsResult result = rig.Track(Known::kNothing);
  ExpectBetterThanAlone(rig, result, 2.5);
  for (const int v : {1, 2}) ExpectViewFound(rig, result, v, 0.15);
}

/// Opposite views show the same outline.
TEST(TrackViews, LeftAndRightOfOppositeViewsAreNotExchanged) {
  const SyntheticRig rig({kFirst, {.yaw_deg = 170, .offset_s = 0.62}});
  const TrackViewsResult result = rig.Track(Known::kNothing);
  ExpectBetterThanAlone(rig, result, 1.3);
  ExpectViewFound(rig, result, 1, 0.2);
  const int left = BuiltinBody().FindJoint("l_wrist"), right = BuiltinBody().FindJoint("r_wrist");
  ASSERT_GE(left, 0);
  ASSERT_GE(right, 0);
  for (int t = 0; t < result.joint.track.num_frames(); ++t) {
    const Vector3d across =
        (result.joint.track.joints[t].row(left) - result.joint.track.joints[t].row(right)).transpose();
    const Vector3d truth =
        (rig.clips[0].truth.joints[t].row(left) - rig.clips[0].truth.joints[t].row(right)).transpose();
    EXPECT_GT(across.dot(truth), 0) << t;
  }
}

TEST(TrackViews, AClockDriftsAndFrameRatesDiffer) {
  const SyntheticRig rig({kFirst, {.yaw_deg = 60, .fps = 25, .begin_s = 0.91, .offset_s = 3.1, .drift = 1e-4}});
  const TrackViewsResult result = rig.Track(Known::kNothing);
  ExpectBetterThanAlone(rig, result, 1.8);
  ExpectViewFound(rig, result, 1, 0.1);
}

TEST(TrackViews, AClockDriftsBy100PartsInAMillion) {
  const double length_s = 20;
  const SyntheticRig rig({{.fps = 15, .begin_s = 0, .length_s = length_s},
                          {.yaw_deg = 80, .fps = 15, .begin_s = 0, .length_s = length_s, .offset_s = 2, .drift = 1e-4}},
                         RandomRigMotion(1, length_s + 1), {}, 1);
  TrackSequenceOptions options = SyntheticRig::Options(2);
  options.estimate_uncertainty = true;
  const TrackViewsResult result = SyntheticRig::Track(rig.Views(Known::kNothing), options);
  ASSERT_TRUE(result.joint.summary.IsUsable()) << result.joint.summary.message;
  const ViewSummary& view = result.joint.summary.views.at(0);
  EXPECT_NEAR(view.rate, 1e-4, 3 * view.rate_sigma);
  EXPECT_LE(view.rate_sigma, 6e-4);
  EXPECT_LE(std::abs(view.rate - 1e-4), 3e-4);
  EXPECT_LE(rig.ClockErrorFrames(view, 1), 0.4);
}

/// Motion tells the clocks, so that there is nothing to tell them by: the deviation is that of the alignment. Place and
/// direction are found all the same.
TEST(TrackViews, WhoStandsStillHasNoClock) {
  Motion still = RandomRigMotion(2, 5);
  for (Eigen::Index t = 1; t < still.poses.rows(); ++t) {
    still.poses.row(t) = still.poses.row(0);
    still.trans.row(t) = still.trans.row(0);
  }
  const RigNoise noise{.white_px = 0, .detector = 1};
  const std::vector<SyntheticCamera> cameras = {{.length_s = 4}, {.yaw_deg = 70, .length_s = 4, .offset_s = 0.4}};
  const SyntheticRig rig(cameras, still, noise, 2), moving(cameras, RandomRigMotion(2, 5), noise, 2);
  TrackSequenceOptions options = SyntheticRig::Options(2);
  options.estimate_uncertainty = true;
  const TrackViewsResult result = SyntheticRig::Track(rig.Views(Known::kNothing), options);
  ASSERT_TRUE(result.joint.summary.IsUsable()) << result.joint.summary.message;
  const ViewSummary& view = result.joint.summary.views.at(0);
  EXPECT_GE(view.offset_sigma_s, 0.3);
  EXPECT_LE(std::abs(view.offset_s - rig.TrueOffset(1)), 3 * view.offset_sigma_s);
  EXPECT_LE(rig.RotationErrorDeg(view, 1), 15);
  const TrackViewsResult told = SyntheticRig::Track(moving.Views(Known::kNothing), options);
  ASSERT_TRUE(told.joint.summary.IsUsable()) << told.joint.summary.message;
  EXPECT_LE(told.joint.summary.views.at(0).offset_sigma_s, 0.03);
}

/// With a detector's noise, slow and white, and landmarks that lie elsewhere on the body than the model's.
TEST(TrackViews, StatedDeviationsCoverTheErrors) {
  constexpr double kLength_s = 3;
  TrackSequenceOptions options = SyntheticRig::Options(2);
  options.estimate_uncertainty = true;
  RigErrors errors;
  for (const auto& [num_views, seed] : std::vector<std::pair<int, uint64_t>>{{4, 1}, {4, 2}, {8, 3}}) {
    const SyntheticRig rig(RandomRigCameras(seed, num_views, kLength_s), RandomRigMotion(seed, kLength_s + 1),
                           {.white_px = 0, .detector = 1, .bias_m = 0.015, .feet = false}, seed);
    const TrackViewsResult result = SyntheticRig::Track(rig.Views(Known::kNothing), options);
    ASSERT_TRUE(result.joint.summary.IsUsable()) << result.joint.summary.message;
    EXPECT_THAT(result.summary.used, testing::Each(1));
    errors.Add(rig, result);
  }
  for (const auto& [name, of] : errors.of) {
    EXPECT_GE(of.Within(2), name == "focal length of the first" ? 0.6 : 0.85) << name;
    EXPECT_GE(of.RmsOfSigma(), name == "mid-hip" ? 0.1 : 0.2) << name;
    EXPECT_LE(of.RmsOfSigma(), 1.5) << name;
  }
  EXPECT_EQ(errors.of.size(), 8U);
}

TEST(TrackViews, ViewsAloneAreTheSameOneByOne) {
  const SyntheticRig rig({{.length_s = 0.8}, {.yaw_deg = 60, .length_s = 0.8, .offset_s = 0.62}});
  TrackSequenceInput common;
  common.body = &BuiltinBody();
  common.prior = &BuiltinPosePrior();
  common.lifter = &BuiltinLifter();
  const std::vector<ObservedView> views = rig.Views(Known::kNothing);
  TrackSequenceOptions options = SyntheticRig::Options(2);
  std::vector<double> fractions;
  options.progress = [&](const TrackProgress& at) {
    fractions.push_back(at.fraction);
    return true;
  };
  FitsProgress fits(options, 3);
  const std::vector<TrackSequenceResult> together = FitViewsAlone(views, common, fits.NextFits(2));
  EXPECT_GT(fractions.size(), 4U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_LE(fractions.back(), 2.0 / 3 + 1e-9);
  ASSERT_EQ(together.size(), 2U);
  for (size_t v = 0; v < 2; ++v) {
    const TrackSequenceResult one = FitViewAlone(views[v], common, options);
    EXPECT_EQ(one.track.motion.poses, together[v].track.motion.poses);
    EXPECT_EQ(one.track.motion.trans, together[v].track.motion.trans);
  }
}

TEST(TrackViews, AnotherMotionIsRefused) {
  const SyntheticRig rig({kFirst, {.yaw_deg = 60, .backwards = true}});
  const TrackViewsResult result = rig.Track(Known::kNothing);
  EXPECT_EQ(result.joint.summary.status, SolveStatus::kFailure);
  EXPECT_THAT(result.joint.summary.message,
              HasSubstr("no other view shows the motion of the first: the motions differ: "));
  EXPECT_THAT(result.summary.used, testing::ElementsAre(1, 0));
  EXPECT_EQ(result.alone.size(), 2U);
  EXPECT_TRUE(result.alone[0].summary.IsUsable());
}

TEST(TrackViews, AThirdViewOfAnotherMotionIsLeftOut) {
  const SyntheticRig rig({kFirst, {.yaw_deg = 120, .backwards = true}, kSecond}), two({kFirst, kSecond});
  const TrackViewsResult result = rig.Track(Known::kNothing);
  ASSERT_TRUE(result.joint.summary.IsUsable()) << result.joint.summary.message;
  EXPECT_THAT(result.summary.used, testing::ElementsAre(1, 0, 1));
  EXPECT_THAT(result.summary.alignment[1].why, HasSubstr("the motions differ"));
  ASSERT_EQ(result.joint.summary.views.size(), 1U);
  EXPECT_LE(rig.RotationErrorDeg(result.joint.summary.views[0], 2), 2);
  EXPECT_LE(rig.ClockErrorFrames(result.joint.summary.views[0], 2), 0.5);
  EXPECT_LT(2 * rig.Joint(result), rig.Alone(result, 0));
}

KeypointSequence ShowingNobody(KeypointSequence keypoints) {
  for (Keypoint& point : keypoints.points) point = {};
  return keypoints;
}

TEST(TrackViews, AViewShowsNobody) {
  const SyntheticRig rig({kFirst, kSecond});
  const KeypointSequence empty = ShowingNobody(rig.clips[1].keypoints);
  std::vector<ObservedView> views = rig.Views(Known::kNothing);
  views[1].keypoints = &empty;
  const TrackViewsResult neither = SyntheticRig::Track(views);
  EXPECT_EQ(neither.joint.summary.status, SolveStatus::kFailure);
  EXPECT_THAT(neither.joint.summary.message, HasSubstr("the person is not seen there"));

  views.push_back(rig.Views(Known::kNothing)[1]);
  const TrackViewsResult result = SyntheticRig::Track(views);
  ASSERT_TRUE(result.joint.summary.IsUsable()) << result.joint.summary.message;
  EXPECT_THAT(result.summary.used, testing::ElementsAre(1, 0, 1));
  const TrackViewsResult without = rig.Track(Known::kNothing);
  EXPECT_EQ(result.joint.track.motion.poses, without.joint.track.motion.poses) << "as if it were not there";
  EXPECT_EQ(result.joint.track.motion.trans, without.joint.track.motion.trans);

  std::swap(views[0], views[1]);
  const TrackViewsResult first = SyntheticRig::Track(views);
  EXPECT_EQ(first.joint.summary.status, SolveStatus::kFailure);
  EXPECT_THAT(first.joint.summary.message, HasSubstr("the first view: "));
}

/// From the same start to the end, in a short clip.
TEST(TrackViews, BothSolversReachTheSameCost) {
  const SyntheticRig rig({{.length_s = 0.6}, {.yaw_deg = 60, .length_s = 0.6, .offset_s = 0.62}});
  std::vector<double> costs;
  for (const SequenceSolver solver : {SequenceSolver::kChain, SequenceSolver::kCeres}) {
    TrackSequenceOptions options = SyntheticRig::Options(2);
    options.solver = solver;
    options.max_iterations = options.max_fine_iterations = 300;
    options.function_tolerance = 1e-10;
    const TrackViewsResult result = SyntheticRig::Track(rig.Views(Known::kNothing), options);
    ASSERT_TRUE(result.joint.summary.IsUsable()) << result.joint.summary.message;
    costs.push_back(result.joint.summary.final_cost);
  }
  EXPECT_NEAR(costs[0], costs[1], 1e-6 * costs[0]);
}

TEST(TrackViews, ThreadsDoNotChangeAByte) {
  const SyntheticRig rig({{.length_s = 1.2}, {.yaw_deg = 60, .length_s = 1.2, .offset_s = 0.62}});
  const TrackViewsResult one = rig.Track(Known::kNothing, 1), two = rig.Track(Known::kNothing, 2);
  EXPECT_EQ(one.joint.track.motion.poses, two.joint.track.motion.poses);
  EXPECT_EQ(one.joint.track.motion.trans, two.joint.track.motion.trans);
  EXPECT_EQ(one.joint.track.motion.betas, two.joint.track.motion.betas);
  EXPECT_EQ(one.joint.summary.final_cost, two.joint.summary.final_cost);
  const ViewSummary &a = one.joint.summary.views.at(0), &b = two.joint.summary.views.at(0);
  EXPECT_EQ(a.camera_from_scene.camera_from_world_rotation, b.camera_from_scene.camera_from_world_rotation);
  EXPECT_EQ(a.camera_from_scene.camera_from_world_translation, b.camera_from_scene.camera_from_world_translation);
  EXPECT_EQ(a.offset_s, b.offset_s);
  EXPECT_EQ(a.camera.fx, b.camera.fx);
}

TEST(TrackViews, ContractErrors) {
  const SyntheticRig rig({{.length_s = 0.2}, {.yaw_deg = 60, .length_s = 0.2}});
  std::vector<ObservedView> views = rig.Views(Known::kAll);
  views[1].camera_from_rig.reset();
  EXPECT_THROW(SyntheticRig::Track(views), std::invalid_argument);
  views.pop_back();
  EXPECT_THROW(SyntheticRig::Track(views), std::invalid_argument);
  EXPECT_THROW(SyntheticRig::Track(std::vector<ObservedView>()), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::track_views_test
