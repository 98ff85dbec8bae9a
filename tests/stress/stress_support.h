// SPDX-License-Identifier: Apache-2.0
/// Support of the stability suite: the engines it runs on, clips with known truth, and invariants of every result. The
/// cases and their guarantees: docs/lab/stability.md.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/body/body_model.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom::stress {

/// Every case that solves runs once with each of these engines (TrackSequenceOptions::solver).
inline const std::vector<std::string>& Engines() {
  static const std::vector<std::string> names = {"ceres", "chain", "chain+ceres"};
  return names;
}

/// Fixture of the cases that solve; GetParam() is the engine.
class EngineTest : public ::testing::TestWithParam<std::string> {};

/// Makes a suite of EngineTest run with every engine: "Suite.Case/ceres".
#define BODYLOOM_WITH_EVERY_ENGINE(suite)                                               \
  INSTANTIATE_TEST_SUITE_P(, suite, ::testing::ValuesIn(::bodyloom::stress::Engines()), \
                           [](const ::testing::TestParamInfo<std::string>& info) {      \
                             std::string name = info.param;                             \
                             std::replace(name.begin(), name.end(), '+', '_');          \
                             return name;                                               \
                           })

/// The demo motion before a camera: `frames` frames at `fps` with realistic detections and `dense` surface keypoints
/// per frame.
SynthClip DemoClip(const BodyModel& body, int frames, double fps = 15, int dense = 0,
                   const SynthClipOptions& options = {});

/// The same for any motion in a world, at its own rate.
SynthClip ClipOf(const BodyModel& body, const Motion& motion, int dense = 0, const SynthClipOptions& options = {});

/// All observations of the clip, with the built-in prior; borrows the clip and the body.
TrackSequenceInput InputOf(const BodyModel& body, const SynthClip& clip);

/// Options of most cases: one thread, no uncertainty.
TrackSequenceOptions OptionsOf(const std::string& engine);

/// Runs TrackSequence() and checks its result by ExpectSound().
TrackSequenceResult Fit(const TrackSequenceInput& input, const TrackSequenceOptions& options);

/// Checks the invariants of every result, for any input: one state and one status per frame; a frame's numbers are all
/// finite or the frame is marked as lost; frame counts are right; a failure has a message; a usable result has a finite
/// cost.
void ExpectSound(const TrackSequenceResult& result, int frames);

/// Mean joint error of frame t in millimetres after a similarity alignment (PA-MPJPE), and of all frames.
double ErrorMm(const TrackSequenceResult& result, const SynthClip& clip, int t);
double ErrorMm(const TrackSequenceResult& result, const SynthClip& clip);

/// Largest distance between the joints of two tracks over the given frames, metres.
double LargestDifference(const Track& a, const Track& b, const std::vector<int>& frames);
double LargestDifference(const Track& a, const Track& b);

/// Largest turn of the root from one frame to the next, radians.
double LargestStep(const Track& track);

/// Angle between the root's rotation and the true one, radians.
double RootErrorRad(const TrackSequenceResult& result, const SynthClip& clip, int t);

/// Memory held by this process, bytes: resident; with the address sanitizer, which delays freeing, the allocated size.
size_t BytesHeld();

}  // namespace bodyloom::stress
