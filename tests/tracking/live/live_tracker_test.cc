// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "data_tools/learned/lifter_weights_io.h"
#include "tests/support/sequence_scene.h"
#include "tracking/live/live_history.h"
#include "tracking/live/track_live.h"
#include "tracking/terms/landmarks.h"

namespace bodyloom::live_tracker_test {
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
    for (const LandmarkObservation& seen : problem.frames[t].Get<LandmarkTerm>().seen) {
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

double MeanJointErrorM(const LiveScene& live, const LiveFrame& frame) {
  const FrameState& truth = live.scene->truth[frame.index];
  double sum = 0;
  for (int j = 0; j < 24; ++j) {
    sum += AxisAngleFromRotation(truth.rotations[j].transpose() * frame.state.rotations[j]).norm() / 24;
  }
  return sum + (truth.translation - frame.state.translation).norm();
}

TEST(LiveTracker, SlowClipsAreReadByTheLifterToo) {
  // Of five frames a second the lifter reads samples between the frames.
  const LifterWeights lifter = BuiltinLifter();
  for (const double fps : {3.0, 5.0, 13.0, 30.0}) {
    LiveScene live = MakeLiveScene(30, false);
    live.input.lifter = &lifter;
    live.options.lag = 2;
    for (size_t t = 0; t < live.frames.size(); ++t) {
      live.frames[t].timestamp = static_cast<double>(t) / fps;
      live.frames[t].initialiser.reset();
    }
    LiveTracker tracker(live.input, live.options);
    int read = 0;
    for (const LiveFrame& frame : RunAll(&tracker, live.frames, 2)) read += frame.standing.has_value() ? 1 : 0;
    EXPECT_GE(read, 24) << fps;
  }
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
      error += MeanJointErrorM(live, out[t]) / static_cast<double>(out.size());
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

/// Frames from ≤ t < to show somebody else, 500 px and two metres beside.
void JumpAway(int from, int to, LiveScene* live) {
  for (int t = from; t < to; ++t) {
    for (Keypoint& point : live->frames[t].keypoints) point.x += 500;
    for (DenseKeypoint& point : live->frames[t].dense) point.pixel.x() += 500;
    live->frames[t].initialiser->trans.x() += 2;
  }
}

std::vector<int> CutsOf(const std::vector<LiveFrame>& frames) {
  std::vector<int> cuts;
  for (const LiveFrame& frame : frames) {
    if (frame.cut_before) cuts.push_back(static_cast<int>(frame.index));
  }
  return cuts;
}

// 25 frames a second: by default frames may be away for 0.15 s, four of them; here also for 0.3 s, eight.
TEST(LiveTracker, AJumpAwayAndBackIsLeftOut) {
  for (const bool dense : {false, true}) {
    LiveScene truth = MakeLiveScene(50, dense);
    LiveTracker undisturbed(truth.input, truth.options);
    const std::vector<LiveFrame> expected = RunAll(&undisturbed, truth.frames, truth.options.lag);
    for (const auto& [length, max_jump_s] : {std::pair(1, 0.15), {2, 0.15}, {4, 0.15}, {5, 0.3}}) {
      LiveScene live = MakeLiveScene(50, dense);
      JumpAway(20, 20 + length, &live);
      live.options.max_jump_s = max_jump_s;
      LiveTracker tracker(live.input, live.options);
      const std::vector<LiveFrame> out = RunAll(&tracker, live.frames, live.options.lag);
      EXPECT_TRUE(CutsOf(out).empty()) << length;
      EXPECT_EQ(tracker.num_frames_left_out(), length);
      for (int t = 0; t < 50; ++t) {
        const bool away = t >= 20 && t < 20 + length;
        EXPECT_EQ(out[t].status, away ? FrameStatus::kInterpolated : FrameStatus::kTracked) << t;
        // Nobody is followed to the other place, and what comes after is as if nothing had happened.
        EXPECT_LT((out[t].state.translation - expected[t].state.translation).norm(), away ? 0.15 : 0.1) << t;
      }
    }
  }
}

TEST(LiveTracker, AJumpThatLastsIsACutAndSoIsTheWayBack) {
  LiveScene live = MakeLiveScene(80, true);
  JumpAway(20, 50, &live);
  LiveTracker tracker(live.input, live.options);
  const std::vector<LiveFrame> out = RunAll(&tracker, live.frames, live.options.lag);
  EXPECT_EQ(CutsOf(out), (std::vector<int>{20, 50}));
  for (int t = 0; t < 80; ++t) EXPECT_EQ(out[t].status, FrameStatus::kTracked) << t;
  for (int t = 21; t < 50; ++t) EXPECT_GT(out[t].state.translation.x() - out[19].state.translation.x(), 1.0) << t;
  EXPECT_EQ(tracker.num_frames_left_out(), 0);
  // With more patience than lag, the first frames of a shot have been handed out before it is known to be one.
  live.options.max_jump_s = 0.3;
  LiveTracker patient(live.input, live.options);
  const std::vector<LiveFrame> late = RunAll(&patient, live.frames, live.options.lag);
  EXPECT_EQ(CutsOf(late), (std::vector<int>{24, 54}));
  for (int t = 20; t < 24; ++t) EXPECT_EQ(late[t].status, FrameStatus::kInterpolated) << t;
  EXPECT_EQ(late[24].status, FrameStatus::kTracked);
  EXPECT_GT(late[24].state.translation.x() - late[19].state.translation.x(), 1.0);
  // Without any, every jump is a cut.
  live.options.max_jump_s = 0;
  live = MakeLiveScene(40, true);
  live.options.max_jump_s = 0;
  JumpAway(20, 21, &live);
  LiveTracker hasty(live.input, live.options);
  EXPECT_EQ(CutsOf(RunAll(&hasty, live.frames, live.options.lag)), (std::vector<int>{20, 21}));
}

TEST(LiveTracker, AJumpWhileNothingWaitsIsLeftOutToo) {
  LiveScene live = MakeLiveScene(40, true);
  live.options.lag = 0;
  JumpAway(20, 23, &live);
  LiveTracker tracker(live.input, live.options);
  const std::vector<LiveFrame> out = RunAll(&tracker, live.frames, 0);
  EXPECT_TRUE(CutsOf(out).empty());
  for (int t = 20; t < 23; ++t) {
    EXPECT_EQ(out[t].status, FrameStatus::kInterpolated);
    EXPECT_LT(std::abs(out[t].state.translation.x() - out[19].state.translation.x()), 0.3);
  }
  EXPECT_EQ(out[23].status, FrameStatus::kTracked);
}

TEST(LiveTracker, EveryFrameComesOutWhateverCame) {
  for (const int lag : {0, 4}) {
    for (const uint64_t seed : {1, 2, 3}) {
      LiveScene live = MakeLiveScene(160, false);
      std::mt19937_64 random(seed);
      std::uniform_int_distribution<int> what(0, 7), length(1, 12);
      double later_s = 0;
      for (int t = 8; t < 160;) {
        const int kind = what(random), end = std::min(160, t + length(random));
        if (kind == 7) later_s += 0.4 * (end - t);  // a gap in time
        if (kind <= 2) JumpAway(t, end, &live);
        for (; t < end; ++t) {
          live.frames[t].timestamp += later_s;
          if (kind == 3) live.frames[t].keypoints.clear();
          if (kind == 4) live.frames[t].keypoints.resize(live.input.landmarks.size());
          if (kind >= 5) live.frames[t].initialiser.reset();
        }
      }
      live.options.lag = lag;
      LiveTracker tracker(live.input, live.options);
      for (const LiveFrame& frame : RunAll(&tracker, live.frames, lag)) {
        EXPECT_EQ(frame.state.translation.allFinite(), frame.status != FrameStatus::kLost) << frame.index;
        EXPECT_EQ(frame.joint_sigma.allFinite(), frame.status != FrameStatus::kLost) << frame.index;
      }
    }
  }
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
    points.reserve(4);
    for (int k = 0; k < 4; ++k) {
      const int side = k % 2, row = k / 2;
      points.push_back({300.0F + 40.0F * float(side), 200.0F + 60.0F * float(row) + float(t % 3), 0.9F});
    }
    EXPECT_EQ(history.Add(t / 30.0, points, 0.15), Continuity::kContinues) << t;
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

std::vector<Keypoint> BodyAt(float x) {
  std::vector<Keypoint> points;
  points.reserve(6);
  for (int k = 0; k < 6; ++k) {
    const int side = k % 2, row = k / 2;
    points.push_back({x + 40.0F * float(side), 200.0F + 50.0F * float(row), 0.9F});
  }
  return points;
}

TEST(LiveHistory, WhatJumpsAwayIsHeldUntilItIsKnown) {
  const std::vector<std::string> names = {"left_shoulder", "right_shoulder", "left_hip",
                                          "right_hip",     "left_knee",      "right_knee"};
  using enum Continuity;
  LiveHistory history(names, 640, 480, 2.0, 64);
  int t = 0;
  const auto add = [&](float x) { return history.Add(t++ / 30.0, x > 0 ? BodyAt(x) : std::vector<Keypoint>(), 0.11); };
  for (int i = 0; i < 5; ++i) EXPECT_EQ(add(300), kContinues);
  // Away for three frames, of which one shows nothing, and back: they stay empty.
  EXPECT_EQ(add(100), kHeld);
  EXPECT_FALSE(history.NewestIsSeen());
  EXPECT_EQ(add(0), kHeld);
  EXPECT_EQ(add(100), kHeld);
  EXPECT_EQ(add(310), kContinues);
  EXPECT_EQ(history.num_frames(), 9);
  EXPECT_EQ(history.Recent(2, 1).at(0, 0).confidence, 0);
  // To one place and on to another: what begins is the shot of the last one.
  EXPECT_EQ(add(100), kHeld);
  EXPECT_EQ(add(100), kHeld);
  EXPECT_EQ(add(500), kHeld);
  EXPECT_EQ(add(500), kHeld);
  EXPECT_EQ(add(500), kCut);
  ASSERT_EQ(history.num_frames(), 3);
  EXPECT_EQ(history.Recent(3, 1).at(0, 0).x, 500);
  EXPECT_EQ(add(500), kContinues);
  // Away, and nothing seen any more: after a second without the person it is a cut, seen or not.
  EXPECT_EQ(add(100), kHeld);
  int held = 0;
  while (add(0) == kHeld) ++held;
  EXPECT_NEAR(held, 29, 1);
}

TEST(LiveHistory, ExchangedSidesAreExchangedBack) {
  LiveHistory history({"left_shoulder", "right_shoulder", "left_hip", "right_hip", "left_knee", "right_knee"}, 640, 480,
                      2.0, 64);
  for (int t = 0; t < 20; ++t) {
    std::vector<Keypoint> points = BodyAt(300);
    if (t == 10) std::swap(points[4], points[5]);
    EXPECT_EQ(history.Add(t / 30.0, points, 0.15), Continuity::kContinues);
    EXPECT_EQ(history.Recent(1, 1).at(0, 4).x, 300) << t;
  }
  EXPECT_EQ(history.num_swaps_repaired(), 1);
}

/// A live scene's observations as sequences, without the initialiser.
struct RecordedClip {
  KeypointSequence keypoints;
  DenseSequence dense;
  TrackSequenceInput input;
  explicit RecordedClip(const LiveScene& live) {
    keypoints.names = live.input.landmarks;
    for (const LiveObservations& frame : live.frames) {
      keypoints.timestamps.push_back(frame.timestamp);
      dense.timestamps.push_back(frame.timestamp);
      keypoints.points.insert(keypoints.points.end(), frame.keypoints.begin(), frame.keypoints.end());
      dense.frames.push_back(frame.dense);
    }
    input.body = live.input.body;
    input.camera = live.input.camera;
    input.keypoints = &keypoints;
    input.dense = &dense;
  }
};

TEST(TrackLive, FillsATrackOfTheWholeClip) {
  LiveScene live = MakeLiveScene(25, true);
  const RecordedClip clip(live);
  const TrackSequenceResult result = TrackLive(clip.input, live.options);
  EXPECT_EQ(result.summary.status, SolveStatus::kConverged);
  EXPECT_EQ(result.track.num_frames(), 25);
  EXPECT_EQ(result.summary.frames_by_status.at("tracked") + result.summary.frames_by_status.at("weak"), 25);
  EXPECT_LT(result.summary.dense_median_px, 6);
  EXPECT_EQ(result.summary.plan.front().what, "live");
  for (LiveObservations& frame : live.frames) frame.initialiser.reset();
  LiveTracker tracker(live.input, live.options);
  const std::vector<LiveFrame> out = RunAll(&tracker, live.frames, live.options.lag);
  for (int t = 0; t < 25; ++t) EXPECT_EQ(result.track.joint_sigma.row(t).transpose(), out[t].joint_sigma) << t;
}

TEST(TrackLive, SaysWhichFramesWereLeftOut) {
  LiveScene live = MakeLiveScene(30, true);
  JumpAway(15, 18, &live);
  const RecordedClip clip(live);
  const TrackSequenceResult result = TrackLive(clip.input, live.options);
  for (int t = 0; t < 30; ++t) {
    EXPECT_EQ(result.track.frame_status[t] == FrameStatus::kInterpolated, t >= 15 && t < 18) << t;
  }
  EXPECT_EQ(result.summary.plan.back().what, "2D joints of impossible frames");
  EXPECT_EQ(result.summary.plan.back().why.substr(0, 8), "3 frames");
}

}  // namespace
}  // namespace bodyloom::live_tracker_test
