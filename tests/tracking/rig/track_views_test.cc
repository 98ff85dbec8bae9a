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

#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/hash_random.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom::track_views_test {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

/// A camera around the person whose clock shows offset_s + (1 + drift) t at time t.
struct RigCamera {
  double yaw_deg = 0, elevation_deg = 8;
  double fps = 30, begin_s = 1, length_s = 2.5, offset_s = 0, drift = 0;
  bool backwards = false;  ///< another motion: this one from its end to its begin
};

constexpr double kMotionRate = 600;

const Motion& WholeMotion() {
  static const Motion motion = DemoMotion(BuiltinBody(), static_cast<int>(6 * kMotionRate), kMotionRate);
  return motion;
}

/// The demo motion at the true times of a camera's frames.
Motion Sampled(const RigCamera& camera) {
  const Motion& whole = WholeMotion();
  Motion motion = whole;
  const int frames = static_cast<int>(std::lround(camera.length_s * camera.fps));
  motion.poses.resize(frames, whole.poses.cols());
  motion.trans.resize(frames, 3);
  motion.timestamps.resize(frames);
  for (int t = 0; t < frames; ++t) {
    const double time = camera.begin_s + t / camera.fps;
    auto row = static_cast<Eigen::Index>(std::lround(time * kMotionRate));
    if (camera.backwards) row = whole.poses.rows() - 1 - row;
    motion.poses.row(t) = whole.poses.row(row);
    motion.trans.row(t) = whole.trans.row(row);
    motion.timestamps[t] = camera.offset_s + (1 + camera.drift) * time;
  }
  return motion;
}

/// Clips of all cameras, with 3 px of white noise, and their truth.
struct SyntheticRig {
  std::vector<RigCamera> cameras;
  std::vector<SynthClip> clips;

  explicit SyntheticRig(std::vector<RigCamera> given) : cameras(std::move(given)) {
    const Motion spanned = Sampled(RigCamera());
    for (size_t v = 0; v < cameras.size(); ++v) {
      SynthClipOptions options;
      options.seed = v + 1;
      options.dense_per_frame = 0;
      options.detection.noise = 0;
      options.detection.swap_probability = 0;
      options.camera.yaw_deg = cameras[v].yaw_deg;
      options.camera.elevation_deg = cameras[v].elevation_deg;
      const SynthCamera camera = PlaceSynthCamera(BuiltinBody(), spanned, options.camera);
      clips.push_back(MakeSynthClip(BuiltinBody(), Sampled(cameras[v]), camera, options));
      HashRandom random(v, {7});
      for (Keypoint& point : clips[v].keypoints.points) {
        point.x += static_cast<float>(3 * random.Normal());
        point.y += static_cast<float>(3 * random.Normal());
      }
    }
  }

  enum class Known { kNothing, kIntrinsics, kAll };
  [[nodiscard]] std::vector<ObservedView> Views(Known known) const {
    std::vector<ObservedView> views;
    for (size_t v = 0; v < clips.size(); ++v) {
      ObservedView& view = views.emplace_back();
      view.keypoints = &clips[v].keypoints;
      if (known == Known::kNothing) continue;
      view.knowledge = CameraKnowledge::kKnown;
      view.camera = clips[v].truth.camera;
      if (known == Known::kIntrinsics) continue;
      view.camera_from_rig = clips[v].camera_from_world;
      view.offset_s = cameras[v].offset_s - cameras[0].offset_s;
    }
    return views;
  }

  static TrackSequenceOptions Options(int threads) {
    TrackSequenceOptions options;
    options.num_threads = threads;
    options.solver = SequenceSolver::kChain;
    options.estimate_uncertainty = false;
    return options;
  }
  static TrackViewsResult Track(const std::vector<ObservedView>& views,
                                const TrackSequenceOptions& options = Options(2)) {
    TrackSequenceInput common;
    common.body = &BuiltinBody();
    common.prior = &BuiltinPosePrior();
    common.lifter = &BuiltinLifter();
    return TrackViews(views, common, options);
  }
  [[nodiscard]] TrackViewsResult Track(Known known, int threads = 2) const {
    return Track(Views(known), Options(threads));
  }

  /// Mean joint error after Procrustes, mm.
  [[nodiscard]] double Joint(const TrackViewsResult& result) const { return Error(result.joint.track, 0); }
  [[nodiscard]] double Alone(const TrackViewsResult& result, int v) const { return Error(result.alone[v].track, v); }

  [[nodiscard]] double RotationErrorDeg(const ViewSummary& found, int v) const {
    const CameraPose truth = Compose(clips[v].camera_from_world, Inverse(clips[0].camera_from_world));
    return RotationAngleBetween(found.camera_from_scene.camera_from_world_rotation, truth.camera_from_world_rotation) *
           180 / M_PI;
  }
  [[nodiscard]] double ClockErrorFrames(const ViewSummary& found, int v) const {
    // At the middle of the first view's clip.
    const std::vector<double>& times = clips[0].keypoints.timestamps;
    const double middle = 0.5 * (times.front() + times.back());
    const double truth = cameras[v].offset_s + cameras[v].drift * middle - cameras[0].offset_s;
    return std::abs(found.offset_s - truth) * cameras[v].fps;
  }

 private:
  [[nodiscard]] double Error(const bodyloom::Track& track, int v) const {
    return 1000 * ProcrustesPositionError(track.joints, clips[v].truth.joints).frames.mean;
  }
};
using Known = SyntheticRig::Known;

constexpr RigCamera kFirst, kSecond = {.yaw_deg = 60, .offset_s = 0.62}, kThird = {.yaw_deg = 150, .offset_s = -0.3};

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
  EXPECT_LT(2 * rig.Joint(result), rig.Alone(result, 0));

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
