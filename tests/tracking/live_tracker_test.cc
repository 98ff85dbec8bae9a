// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_tracker.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/sequence_scene.h"
#include "tracking/live/live_history.h"
#include "tracking/live/track_live.h"

namespace bodyloom {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The toy body in smooth motion, seen as all of its landmarks, with what it takes to track it.
struct LiveScene {
  std::unique_ptr<SequenceScene> scene;
  LiveTrackerInput input;
  LiveTrackerOptions options;
  std::vector<LiveObservations> frames;
};

LiveScene MakeLiveScene(int count, bool dense) {
  LiveScene live;
  SequenceSceneOptions options;
  options.frames = count;
  options.outliers = 0;
  options.start_error = 0.02;
  live.scene = MakeSequenceScene(options);
  const SequenceProblem& problem = live.scene->problem;
  const BodyModel& body = live.scene->body;
  live.input.body = &body;
  live.input.camera = problem.layout.camera;
  live.input.dense = dense;
  live.options.solve.num_threads = 1;
  for (const Landmark& landmark : body.data().landmarks) live.input.landmarks.push_back(landmark.name);
  for (int t = 0; t < count; ++t) {
    LiveObservations frame;
    frame.timestamp = problem.timestamps[t];
    frame.keypoints.resize(live.input.landmarks.size());
    for (const LandmarkObservation& seen : problem.frames[t].landmarks) {
      const auto k = seen.point - live.scene->landmarks.data();
      frame.keypoints[k] = {static_cast<float>(seen.pixel.x()), static_cast<float>(seen.pixel.y()), 0.9F};
    }
    if (dense) frame.dense = live.scene->dense[t];
    frame.initialiser = BodyPose{problem.states[t].rotations, problem.states[t].translation};
    live.frames.push_back(frame);
  }
  return live;
}

std::vector<LiveFrame> RunAll(LiveTracker* tracker, const std::vector<LiveObservations>& frames, int lag) {
  std::vector<LiveFrame> out;
  for (size_t t = 0; t < frames.size(); ++t) {
    std::optional<LiveFrame> frame = tracker->Push(frames[t]);
    EXPECT_EQ(frame.has_value(), static_cast<int>(t) >= lag) << t;
    if (!frame) continue;
    EXPECT_EQ(frame->index, static_cast<int64_t>(t) - lag);
    out.push_back(std::move(*frame));
  }
  for (LiveFrame& frame : tracker->Finish()) out.push_back(std::move(frame));
  EXPECT_EQ(out.size(), frames.size());
  return out;
}

double MeanJointError_m(const LiveScene& live, const LiveFrame& frame) {
  const FrameState& truth = live.scene->truth[frame.index];
  double sum = 0;
  for (int j = 0; j < 24; ++j) {
    sum += AxisAngleFromRotation(truth.rotations[j].transpose() * frame.state.rotations[j]).norm() / 24;
  }
  return sum + (truth.translation - frame.state.translation).norm();
}

TEST(LiveTracker, EveryFrameComesOutAtTheStatedLagAndNearTheTruth) {
  for (const int lag : {0, 1, 4}) {
    LiveScene live = MakeLiveScene(30, true);
    live.options.lag = lag;
    LiveTracker tracker(live.input, live.options);
    const std::vector<LiveFrame> out = RunAll(&tracker, live.frames, lag);
    double error = 0;
    for (size_t t = 0; t < out.size(); ++t) {
      EXPECT_EQ(out[t].index, static_cast<int64_t>(t));
      EXPECT_EQ(out[t].timestamp, live.frames[t].timestamp);
      EXPECT_EQ(out[t].status, FrameStatus::kTracked);
      EXPECT_FALSE(out[t].cut_before);
      error += MeanJointError_m(live, out[t]) / static_cast<double>(out.size());
    }
    EXPECT_LT(error, 0.25) << lag;
  }
}

TEST(LiveTracker, SameBytesForAnyNumberOfThreads) {
  LiveScene live = MakeLiveScene(20, true);
  std::vector<LiveFrame> expected;
  for (const int threads : {1, 2, 5}) {
    live.options.solve.num_threads = threads;
    LiveTracker tracker(live.input, live.options);
    const std::vector<LiveFrame> out = RunAll(&tracker, live.frames, live.options.lag);
    if (threads == 1) expected = out;
    for (size_t t = 0; t < out.size(); ++t) {
      EXPECT_EQ(out[t].state.rotations, expected[t].state.rotations) << threads;
      EXPECT_EQ(out[t].state.translation, expected[t].state.translation) << threads;
      EXPECT_EQ(out[t].betas, expected[t].betas) << threads;
    }
  }
}

TEST(LiveTracker, SigmaIsThatOfTheWindowAndChangesNothing) {
  LiveScene live = MakeLiveScene(26, true);
  for (int t = 12; t < 18; ++t) {
    live.frames[t].keypoints.clear();
    live.frames[t].dense.clear();
    live.frames[t].initialiser.reset();
  }
  LiveTracker tracker(live.input, live.options);
  const std::vector<LiveFrame> with = RunAll(&tracker, live.frames, live.options.lag);
  live.options.solve.estimate_uncertainty = false;
  LiveTracker other(live.input, live.options);
  const std::vector<LiveFrame> without = RunAll(&other, live.frames, live.options.lag);
  for (size_t t = 0; t < with.size(); ++t) {
    EXPECT_EQ(with[t].state.rotations, without[t].state.rotations) << t;
    EXPECT_EQ(with[t].state.translation, without[t].state.translation) << t;
    EXPECT_EQ(with[t].betas, without[t].betas) << t;
    ASSERT_EQ(with[t].joint_sigma.size(), 24);
    EXPECT_GT(with[t].joint_sigma.minCoeff(), 1e-3) << t;
    EXPECT_LT(with[t].joint_sigma.maxCoeff(), 0.5) << t;
    ASSERT_EQ(without[t].joint_sigma.size(), 24);
    EXPECT_TRUE(without[t].joint_sigma.array().isNaN().all());
  }
  EXPECT_GT(with[15].joint_sigma.mean(), 2 * with[8].joint_sigma.mean());  // carried
}

TEST(LiveTracker, FramesWithoutObservationsAreCarriedAndThenLost) {
  LiveScene live = MakeLiveScene(60, false);  // 25 frames a second
  live.options.lost_after_s = 0.5;
  for (int t = 20; t < 45; ++t) {
    live.frames[t].initialiser.reset();
    if (t % 2 == 0) live.frames[t].keypoints.clear();
    for (Keypoint& point : live.frames[t].keypoints) point = {static_cast<float>(kNaN), 1e30F, 0.9F};
  }
  LiveTracker tracker(live.input, live.options);
  const std::vector<LiveFrame> out = RunAll(&tracker, live.frames, live.options.lag);
  EXPECT_EQ(out[19].status, FrameStatus::kTracked);
  EXPECT_EQ(out[20].status, FrameStatus::kInterpolated);
  EXPECT_EQ(out[30].status, FrameStatus::kInterpolated);
  EXPECT_TRUE(out[30].state.translation.allFinite());
  EXPECT_EQ(out[40].status, FrameStatus::kLost);
  EXPECT_FALSE(out[40].state.translation.allFinite());
  EXPECT_TRUE(out[40].joint_sigma.array().isNaN().all());
  EXPECT_TRUE(out[30].joint_sigma.allFinite());
  EXPECT_EQ(out[45].status, FrameStatus::kTracked);
  EXPECT_TRUE(out[45].cut_before);
  EXPECT_EQ(out[59].status, FrameStatus::kTracked);
}

TEST(LiveTracker, ACutBeginsAnotherShot) {
  LiveScene live = MakeLiveScene(40, false);
  for (int t = 20; t < 40; ++t) {
    for (Keypoint& point : live.frames[t].keypoints) point.x += 500;
    live.frames[t].initialiser->trans.x() += 2;
  }
  LiveTracker tracker(live.input, live.options);
  const std::vector<LiveFrame> out = RunAll(&tracker, live.frames, live.options.lag);
  for (int t = 0; t < 40; ++t) EXPECT_EQ(out[t].cut_before, t == 20) << t;
  EXPECT_GT(out[20].state.translation.x() - out[19].state.translation.x(), 1.2);
}

TEST(LiveTracker, NothingIsSeenAtAll) {
  LiveScene live = MakeLiveScene(20, false);
  for (LiveObservations& frame : live.frames) {
    frame.keypoints.clear();
    frame.initialiser.reset();
  }
  LiveTracker tracker(live.input, live.options);
  for (const LiveFrame& frame : RunAll(&tracker, live.frames, live.options.lag)) {
    EXPECT_EQ(frame.status, FrameStatus::kLost);
  }
  // And the next clip begins afresh, from the first time again.
  const LiveScene other = MakeLiveScene(20, false);
  tracker = LiveTracker(other.input, other.options);
  EXPECT_EQ(RunAll(&tracker, other.frames, other.options.lag)[10].status, FrameStatus::kTracked);
}

TEST(LiveTracker, RefusesWhatCannotBeAndGoesOn) {
  LiveScene live = MakeLiveScene(12, true);
  LiveTracker tracker(live.input, live.options);
  std::vector<LiveFrame> out;
  for (const LiveObservations& frame : live.frames) {
    LiveObservations wrong = frame;
    wrong.timestamp = kNaN;
    EXPECT_THROW(tracker.Push(wrong), std::invalid_argument);
    wrong = frame;
    wrong.keypoints.pop_back();
    EXPECT_THROW(tracker.Push(wrong), std::invalid_argument);
    wrong = frame;
    wrong.dense[0].face = 1 << 20;
    EXPECT_THROW(tracker.Push(wrong), std::invalid_argument);
    if (std::optional<LiveFrame> done = tracker.Push(frame)) out.push_back(std::move(*done));
    EXPECT_THROW(tracker.Push(frame), std::invalid_argument);  // the same time again
  }
  EXPECT_EQ(out.size(), 8U);
  EXPECT_EQ(out.back().status, FrameStatus::kTracked);
  live.options.lag = -1;
  EXPECT_THROW(LiveTracker(live.input, live.options), std::invalid_argument);
}

TEST(LiveHistory, MemoryIsBoundedAndTheSampleSpansTheShot) {
  LiveHistory history({"left_hip", "right_hip", "left_knee", "right_knee"}, 640, 480, 2.0, 64);
  for (int t = 0; t < 5000; ++t) {
    std::vector<Keypoint> points;
    for (int k = 0; k < 4; ++k) {
      points.push_back({300.0F + 40.0F * float(k % 2), 200.0F + 60.0F * float(k / 2) + float(t % 3), 0.9F});
    }
    EXPECT_FALSE(history.Add(t / 30.0, points)) << t;
    EXPECT_LE(history.num_frames(), 64 + 64 / 4 + 1);
    EXPECT_LE(history.Sample().num_frames(), 64);
  }
  EXPECT_EQ(history.Sample().timestamps.front(), 0);
  EXPECT_GT(history.Sample().timestamps.back(), 4500 / 30.0);
  EXPECT_NEAR(history.TimeStep(), 1 / 30.0, 1e-9);
  const KeypointSequence recent = history.Recent(5, 3);
  ASSERT_EQ(recent.num_frames(), 5);
  EXPECT_EQ(recent.timestamps.back(), 4999 / 30.0);
  EXPECT_EQ(recent.timestamps.front(), (4999 - 12) / 30.0);
}

TEST(LiveHistory, ExchangedSidesAreExchangedBack) {
  LiveHistory history({"left_shoulder", "right_shoulder", "left_hip", "right_hip", "left_knee", "right_knee"}, 640, 480,
                      2.0, 64);
  for (int t = 0; t < 20; ++t) {
    std::vector<Keypoint> points;
    for (int k = 0; k < 6; ++k) points.push_back({300.0F + 40.0F * float(k % 2), 200.0F + 50.0F * float(k / 2), 0.9F});
    if (t == 10) std::swap(points[4], points[5]);
    EXPECT_FALSE(history.Add(t / 30.0, points));
    EXPECT_EQ(history.Recent(1, 1).at(0, 4).x, 300) << t;
  }
  EXPECT_EQ(history.num_swaps_repaired(), 1);
}

TEST(TrackLive, FillsATrackOfTheWholeClip) {
  LiveScene live = MakeLiveScene(25, true);
  KeypointSequence keypoints;
  keypoints.names = live.input.landmarks;
  DenseSequence dense;
  for (const LiveObservations& frame : live.frames) {
    keypoints.timestamps.push_back(frame.timestamp);
    dense.timestamps.push_back(frame.timestamp);
    keypoints.points.insert(keypoints.points.end(), frame.keypoints.begin(), frame.keypoints.end());
    dense.frames.push_back(frame.dense);
  }
  TrackSequenceInput input;
  input.body = live.input.body;
  input.camera = live.input.camera;
  input.keypoints = &keypoints;
  input.dense = &dense;
  const TrackSequenceResult result = TrackLive(input, live.options);
  EXPECT_EQ(result.summary.status, SolveStatus::kConverged);
  EXPECT_EQ(result.track.num_frames(), 25);
  LiveTracker tracker(live.input, live.options);
  const std::vector<LiveFrame> out = RunAll(
      &tracker,
      [&]() {
        std::vector<LiveObservations> frames = live.frames;
        for (LiveObservations& frame : frames) frame.initialiser.reset();
        return frames;
      }(),
      live.options.lag);
  for (int t = 0; t < 25; ++t) EXPECT_EQ(result.track.joint_sigma.row(t).transpose(), out[t].joint_sigma) << t;
  EXPECT_EQ(result.summary.frames_by_status.at("tracked") + result.summary.frames_by_status.at("weak"), 25);
  EXPECT_LT(result.summary.dense_median_px, 6);
  EXPECT_EQ(result.summary.plan.front().what, "live");
}

}  // namespace
}  // namespace bodyloom
