// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/solve_track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "pipelines/track/track_clip.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::track_to_memory_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

SynthClip Seen() {
  SynthClipOptions options;
  options.camera.width = 320;
  options.camera.height = 240;
  options.dense_per_frame = 0;
  options.num_threads = 1;
  return MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 16, 15), options);
}

std::string BytesOf(const TrackSequenceResult& result, const ScratchFolder& folder) {
  WriteTrack(folder / "memory.npz", result.track);
  return ReadFileBytes(folder / "memory.npz");
}

TEST(TrackToMemory, TheTrackIsTrackClipsToTheByte) {
  const ScratchFolder folder;
  const SynthClip clip = Seen();
  WriteObservations(folder / "seen.npz", &clip.keypoints, nullptr);
  TrackRequest request;
  request.detections = folder / "seen.npz";
  request.focal_px = 300;
  request.out = folder / "track.npz";
  TrackClip(request);
  const std::string expected = ReadFileBytes(request.out);
  EXPECT_EQ(BytesOf(TrackToMemory(request), folder), expected);

  TrackRequest given_request;
  GivenInMemory given;
  given.keypoints = &clip.keypoints;
  given.body = BodyOrBuiltin("");
  given.camera = MakePinhole(320, 240, 300);
  EXPECT_EQ(BytesOf(TrackToMemory(given_request, given), folder), expected);
  EXPECT_EQ(folder.Entries(), (std::vector<std::string>{"memory.npz", "seen.npz", "track.npz"}));
}

TEST(TrackToMemory, WhatIsGivenIsNamedInMessages) {
  SynthClip clip = Seen();
  GivenInMemory given;
  given.keypoints = &clip.keypoints;
  given.camera = MakePinhole(100, 100, 90);
  EXPECT_THAT([&] { TrackToMemory({}, given); },
              ThrowsMessage<std::runtime_error>(HasSubstr("keypoints: made for images of 320x240")));
  TrackRequest request;
  request.focal_px = 80;
  EXPECT_THAT([&] { TrackToMemory(request, given); }, ThrowsMessage<RequestError>(HasSubstr("--cameras and --focal")));
  EXPECT_THAT([] { TrackToMemory({}); }, ThrowsMessage<RequestError>(HasSubstr("--video is required")));
}

TEST(TrackToMemory, NothingToTrackIsAStatus) {
  SynthClip clip = Seen();
  for (Keypoint& point : clip.keypoints.points) point.confidence = 0;
  GivenInMemory given;
  given.keypoints = &clip.keypoints;
  const TrackSequenceResult result = TrackToMemory({}, given);
  EXPECT_FALSE(result.summary.IsUsable());
  EXPECT_FALSE(result.summary.message.empty());
}

TEST(TrackToMemory, ProgressCancels) {
  const SynthClip clip = Seen();
  GivenInMemory given;
  given.keypoints = &clip.keypoints;
  PipelineCallbacks callbacks;
  callbacks.progress = [](const std::string&, double) { return false; };
  EXPECT_THROW(TrackToMemory({}, given, callbacks), Cancelled);
}

}  // namespace
}  // namespace bodyloom::track_to_memory_test
