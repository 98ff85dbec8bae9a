// SPDX-License-Identifier: Apache-2.0
// Observations of other views at the times of the first one's frames, against closed forms and a synthetic rig.
#include "tracking/clip/clip_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_camera.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/initialise/view_observations.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/solvers/term_costs.h"

namespace bodyloom::clip_views_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// ---- SampleKeypoints ------------------------------------------------------------------------------------------------

const Vector2d kPlace(100, 200), kVelocity(80, -48);

/// Two landmarks: one moves evenly, through kPlace at 0, and the other stands.
KeypointSequence Moving(const std::vector<double>& times) {
  KeypointSequence seen;
  seen.names = {"nose", "left_eye"};
  seen.timestamps = times;
  for (const double t : times) {
    const Vector2d at = kPlace + t * kVelocity;
    seen.points.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()), 0.9F});
    seen.points.push_back({50, 60, 0.5F});
  }
  return seen;
}

void ExpectSeen(const SampledKeypoint& seen, double t, float confidence = 0.9F) {
  const Vector2d at = kPlace + t * kVelocity;
  EXPECT_NEAR(seen.point.x, at.x(), 1e-4) << t;
  EXPECT_NEAR(seen.point.y, at.y(), 1e-4) << t;
  EXPECT_NEAR(seen.point.confidence, confidence, 1e-6) << t;
  EXPECT_NEAR((seen.velocity_px_s - kVelocity).norm(), 0, 1e-2) << t;
}

TEST(SampleKeypoints, EvenMotionIsExact) {
  const KeypointSequence steady = Moving({0, 0.04, 0.08, 0.12, 0.16, 0.2});
  const KeypointSequence uneven = Moving({0, 0.013, 0.06, 0.075, 0.14, 0.2});
  for (const KeypointSequence* keypoints : {&steady, &uneven}) {
    for (const double t : {0.0, 0.01, 0.04, 0.059, 0.07, 0.11, 0.16, 0.2}) {
      const auto seen = SampleKeypoints(*keypoints, t);
      ASSERT_EQ(seen.size(), 2U);
      ExpectSeen(seen[0], t);
      EXPECT_FLOAT_EQ(seen[1].point.x, 50);
      EXPECT_FLOAT_EQ(seen[1].point.y, 60);
      EXPECT_FLOAT_EQ(seen[1].point.confidence, 0.5F);
      EXPECT_LE(seen[1].velocity_px_s.norm(), 1e-9);
    }
  }
}

TEST(SampleKeypoints, NothingIsKnownBeforeTheFirstAndAfterTheLastFrame) {
  const KeypointSequence keypoints = Moving({1, 1.04, 1.08});
  for (const double t : {0.0, 0.999, 1.0801, 1.09, 5.0}) {
    for (const SampledKeypoint& seen : SampleKeypoints(keypoints, t)) {
      EXPECT_EQ(seen.point.confidence, 0) << t;
      EXPECT_EQ(seen.velocity_px_s, Vector2d(0, 0)) << t;
    }
  }
  EXPECT_GT(SampleKeypoints(keypoints, 1)[0].point.confidence, 0);
  EXPECT_GT(SampleKeypoints(keypoints, 1.08)[0].point.confidence, 0);
  EXPECT_GT(SampleKeypoints(Moving({1}), 1)[0].point.confidence, 0);
  EXPECT_EQ(SampleKeypoints(Moving({1}), 1.01)[0].point.confidence, 0);
}

TEST(SampleKeypoints, GapsAreBridgedUpToTheLimit) {
  const KeypointSequence keypoints = Moving({0, 0.04, 0.18, 0.34, 0.38});
  ExpectSeen(SampleKeypoints(keypoints, 0.05)[0], 0.05);
  const SampledKeypoint middle = SampleKeypoints(keypoints, 0.11)[0];  // no detection within 0.06 s: no velocity
  EXPECT_NEAR(middle.point.x, kPlace.x() + 0.11 * kVelocity.x(), 1e-4);
  EXPECT_EQ(middle.velocity_px_s, Vector2d(0, 0));
  for (const double t : {0.181, 0.25, 0.339}) EXPECT_EQ(SampleKeypoints(keypoints, t)[0].point.confidence, 0) << t;
  EXPECT_GT(SampleKeypoints(keypoints, 0.35)[0].point.confidence, 0);
}

TEST(SampleKeypoints, LowConfidenceIsNotKnown) {
  KeypointSequence keypoints = Moving({0, 0.04, 0.08, 0.12, 0.16});
  keypoints.at(2, 0) = {1e4F, 1e4F, 0.05F};
  EXPECT_EQ(SampleKeypoints(keypoints, 0.07)[0].point.confidence, 0);
  EXPECT_EQ(SampleKeypoints(keypoints, 0.1)[0].point.confidence, 0);
  ExpectSeen(SampleKeypoints(keypoints, 0.03)[0], 0.03);  // nor does it enter the velocity beside it
  ExpectSeen(SampleKeypoints(keypoints, 0.13)[0], 0.13);
  EXPECT_EQ(SampleKeypoints(keypoints, 0.07)[1].point.confidence, 0.5F);
  keypoints.at(1, 0).confidence = 0.3F;  // the lower one of both
  ExpectSeen(SampleKeypoints(keypoints, 0.03)[0], 0.03, 0.3F);
  keypoints.at(0, 0).x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(SampleKeypoints(keypoints, 0.03)[0].point.confidence, 0);
}

/// White noise of σ pixels gives a velocity of σ / √Σ (t_i − t̄)².
TEST(SampleKeypoints, VelocityIsTheSlopeOfTheLeastSquaresLine) {
  const std::vector<double> times = {0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12};
  KeypointSequence keypoints = Moving(times);
  const double t = 0.055;  // sees the frames from 0 to 0.1
  const std::vector<float> noise = {1, -2, 3, 0.5F, -1, 2, 40};
  double expected = 0, square = 0;
  for (int i = 0; i < 7; ++i) {
    keypoints.at(i, 0).x += noise[i];
    if (i == 6) continue;
    expected += (times[i] - 0.05) * noise[i];
    square += (times[i] - 0.05) * (times[i] - 0.05);
  }
  EXPECT_NEAR(SampleKeypoints(keypoints, t)[0].velocity_px_s.x(), kVelocity.x() + expected / square, 1e-2);
}

// ---- ClipViews ------------------------------------------------------------------------------------------------------

/// The demo motion before a camera, and as a second one sees it, exactly and with another clock and frame rate.
class Rig {
 public:
  static constexpr double kOffset_s = 0.31, kDrift = 2e-4;

  explicit Rig(bool clock_known, double assumed_offset_s = kOffset_s, double assumed_drift = kDrift) {
    const BodyModel& body = BuiltinBody();
    const CameraPose pose{RotationFromAxisAngle({M_PI, 0, 0}), Vector3d(0, 1, 6)};
    CameraPose other{RotationFromAxisAngle({0, 1.0, 0}), {}};
    other.camera_from_world_translation = Vector3d(0.1, 0, 6) - other.camera_from_world_rotation * Vector3d(0, 0, 6);
    const Motion motion = MotionInCamera(body, DemoMotion(body, 720, kMotionRate), pose);
    std::vector<int> joints(body.num_joints());
    std::iota(joints.begin(), joints.end(), 0);
    problem.layout = FrameLayout::Make(body, CameraKnowledge::kKnown, camera_, joints, body.num_betas());
    problem.betas = Eigen::VectorXd::Zero(body.num_betas());
    problem.log_focal = problem.log_focal_prior = std::log(camera_.fx);
    first_.names = second_.names = CocoNames();
    landmarks_ = FindObservedLandmarks(body, &first_, body.num_betas());
    lifted_landmarks_ = CompileLiftedLandmarks(body, body.num_betas());
    // The first view shows every eighth frame of the motion from frame 400 on, the second one all from frame 300 on.
    for (int t = 0; t < kFrames; ++t) {
      problem.states.push_back(StateOf(motion, 400 + 8 * t));
      problem.timestamps.push_back(t / 30.0);
      problem.cut_before.push_back(0);
      See(problem.states.back(), problem.timestamps.back(), &first_);
    }
    for (int i = 300; i < 720; ++i) {
      const double t = (i - 400) / kMotionRate;
      const FrameState state = StateInCamera(problem.layout, other, problem.betas, StateOf(motion, i));
      See(state, t + kOffset_s + kDrift * (t - middle_s()), &second_);
    }
    ViewInput& view = views_.emplace_back();
    view.keypoints = &second_;
    view.knowledge = CameraKnowledge::kKnown;
    view.camera = camera_;
    view.camera_from_scene = other;
    view.pose_known = true;
    view.clock_known = clock_known;
    view.offset_s = assumed_offset_s;
    view.rate = assumed_drift;
    input_.body = &body;
    input_.keypoints = &first_;
    input_.camera = camera_;
    input_.views = &views_;
    AddViews(input_, &problem);
    problem.frames.resize(kFrames);
    observed_.push_back({second_, {}});
    term = MakeClipViews({.input = input_,
                          .options = options_,
                          .layout = problem.layout,
                          .landmarks = landmarks_,
                          .joints = &first_,
                          .lifted = lifted_,
                          .lifted_landmarks = lifted_landmarks_,
                          .views = observed_,
                          .stature_m = 1.7});
    term->Observe(&problem);
  }

  [[nodiscard]] double middle_s() const { return 0.5 * (kFrames - 1) / 30.0; }
  [[nodiscard]] std::vector<int> AllFrames() const {
    std::vector<int> all(kFrames);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  /// Of the second view's 2D joints.
  [[nodiscard]] double Cost() const {
    for (const TermCosts& costs : CostsByTerm(problem, 1)) {
      if (costs.term == "2D joints, view 2") return costs.cost;
    }
    ADD_FAILURE() << "no term of the second view";
    return -1;
  }

  static constexpr int kFrames = 24;
  SequenceProblem problem;
  std::unique_ptr<ClipTerm> term;

 private:
  static constexpr double kMotionRate = 240;

  [[nodiscard]] FrameState StateOf(const Motion& motion, int i) const {
    const BodyPose pose =
        PoseFromAxisAngle(BuiltinBody(), motion.poses.row(i).transpose(), motion.trans.row(i).transpose());
    return {pose.rotations, pose.trans};
  }
  void See(const FrameState& state, double time, KeypointSequence* seen) const {
    Kinematics kinematics;
    kinematics.Set(BuiltinBody(), problem.betas, state.rotations, state.translation, false);
    PointEvaluator points;
    seen->timestamps.push_back(time);
    for (const CompiledPoint& point : landmarks_.points) {
      Vector2d pixel;
      ASSERT_TRUE(camera_.Project(points.Evaluate(kinematics, point, false), &pixel));
      seen->points.push_back({static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), 1});
    }
  }

  Camera camera_ = MakePinhole(1280, 960, 1200);
  TrackSequenceInput input_;
  TrackSequenceOptions options_;
  KeypointSequence first_, second_;
  std::vector<ViewInput> views_;
  std::vector<ViewObservations> observed_;
  ObservedLandmarks landmarks_;
  LiftedStart lifted_;
  LiftedLandmarks lifted_landmarks_;
};

TEST(ClipViews, TheTrueCameraAndClockCostNothing) {
  for (const bool clock_known : {true, false}) {
    const Rig rig(clock_known);
    ASSERT_EQ(rig.problem.views.size(), 1U);
    int seen = 0;
    for (const FrameData& frame : rig.problem.frames) {
      ASSERT_EQ(frame.views.size(), 1U);
      seen += static_cast<int>(frame.views[0].terms.Get<LandmarkTerm>().seen.size());
    }
    EXPECT_EQ(seen, 17 * Rig::kFrames);
    EXPECT_LE(rig.Cost(), 1e-5);
    TrackSequenceSummary summary;
    rig.term->Summarise(rig.problem, &summary);
    ASSERT_EQ(summary.views.size(), 1U);
    EXPECT_EQ(summary.views[0].frames, Rig::kFrames);
    EXPECT_LE(summary.views[0].reprojection_median_px, 0.05);
    EXPECT_EQ(summary.views[0].offset_s, Rig::kOffset_s);
    EXPECT_EQ(summary.views[0].rate, Rig::kDrift);
    EXPECT_EQ(std::isnan(summary.views[0].offset_sigma_s), !clock_known);
    EXPECT_EQ(summary.views[0].rotation_sigma_rad, 0);
  }
}

TEST(ClipViews, AWrongCameraOrClockCosts) {
  EXPECT_GT(Rig(true, Rig::kOffset_s + 0.1).Cost(), 1);
  EXPECT_GT(Rig(true, Rig::kOffset_s, Rig::kDrift + 0.2).Cost(), 0.5);
  Rig rig(true);
  rig.problem.views[0].camera_from_scene.camera_from_world_translation.x() += 0.2;
  EXPECT_GT(rig.Cost(), 10);
}

/// The terms are moved by the velocities to first order, and made again where the problem's clock is.
TEST(ClipViews, StartRoundSamplesByTheProblemsClock) {
  for (const double off : {0.02, 0.08}) {
    Rig rig(false, Rig::kOffset_s + off, 0);
    const double wrong = rig.Cost();
    rig.problem.views[0].offset_s = Rig::kOffset_s;
    rig.problem.views[0].rate = Rig::kDrift;
    const double moved = rig.Cost();
    EXPECT_LT(moved, 0.3 * wrong) << off;
    rig.term->StartRound(0, rig.AllFrames(), &rig.problem);
    EXPECT_LE(rig.Cost(), 1e-5) << off;
    EXPECT_LT(rig.Cost(), moved) << off;
    for (const FrameData& frame : rig.problem.frames) {
      EXPECT_EQ(frame.views[0].sampled_s, Rig::kOffset_s + Rig::kDrift * frame.views[0].clock_s);
    }
  }
  EXPECT_EQ(Rig(true).term->rounds().count, 0);
  EXPECT_GT(Rig(false).term->rounds().count, 0);
}

/// Also on a selection of frames, whose middle is not the clip's.
TEST(ClipViews, ASelectionOfFramesKeepsItsClock) {
  const Rig rig(false);
  SequenceProblem coarse = SelectFrames(rig.problem, {1, 3, 6});
  rig.term->StartRound(0, {1, 3, 6}, &coarse);
  for (size_t i = 0; i < coarse.frames.size(); ++i) {
    EXPECT_NEAR(coarse.frames[i].views[0].clock_s, coarse.timestamps[i] - rig.middle_s(), 1e-12);
    EXPECT_EQ(coarse.frames[i].views[0].terms.Get<LandmarkTerm>().seen.size(), 17U);
  }
  double cost = 0;
  for (const TermCosts& costs : CostsByTerm(coarse, 1)) cost += costs.term == "2D joints, view 2" ? costs.cost : 0;
  EXPECT_LE(cost, 1e-5);
}

}  // namespace
}  // namespace bodyloom::clip_views_test
