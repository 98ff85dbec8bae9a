// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/track/track_clip.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "bodyloom/pipelines/synthesis/synthesize_clip.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom {
namespace {

SynthClipFiles SmallClip(const ScratchFolder& folder) {
  SynthesizeClipRequest request;
  request.motion = {.name = "demo", .fps = 15, .num_frames = 8};
  request.out = folder / "clip";
  request.clip.dense_per_frame = 0;
  return SynthesizeClip(request).files;
}

TEST(TrackClip, ReportsWhatItWroteAndHowFarItIs) {
  const ScratchFolder folder;
  const SynthClipFiles clip = SmallClip(folder);
  TrackRequest request;
  request.detections = clip.observations;
  request.cameras = clip.camera;
  request.out = folder / "track.npz";
  request.json = folder / "track.json";
  PipelineCallbacks callbacks;
  std::string work;
  double fraction = 0;
  callbacks.begin = [&](const std::string& name) { work = name; };
  callbacks.progress = [&](const std::string&, double done) {
    fraction = done;
    return true;
  };
  const TrackReport report = TrackClip(request, callbacks);
  EXPECT_EQ(work, "tracking 8 frames");
  EXPECT_EQ(fraction, 1);
  EXPECT_EQ(report.num_frames, 8);
  EXPECT_EQ(report.outputs, (std::vector<std::string>{request.out, request.json}));
  EXPECT_EQ(FileBytes(request.json), ToJson(report));
  EXPECT_TRUE(std::filesystem::exists(request.out));
}

TEST(TrackClip, ACancelledOneLeavesNothingBehind) {
  const ScratchFolder folder;
  const SynthClipFiles clip = SmallClip(folder);
  TrackRequest request;
  request.detections = clip.observations;
  request.cameras = clip.camera;
  request.out = folder / "track.npz";
  PipelineCallbacks callbacks;
  callbacks.progress = [&](const std::string&, double done) { return done < 0.2; };
  EXPECT_THROW(TrackClip(request, callbacks), Cancelled);
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"clip"});
}

}  // namespace
}  // namespace bodyloom
