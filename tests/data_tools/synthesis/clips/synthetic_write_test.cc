// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/synthesis/clips/write_synth_clip.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/data_tools/observations/load_detections.h"
#include "bodyloom/data_tools/observations/observations_npz.h"
#include "bodyloom/data_tools/synthesis/clips/demo_motion.h"
#include "bodyloom/data_tools/video/video_reader.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/toy_body.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

SynthClipOptions Options() {
  SynthClipOptions options;
  options.camera.width = 160;
  options.camera.height = 120;
  options.dense_per_frame = 50;
  options.dense.pixel_sigma_px = 1;
  options.initialiser_error_px = 12;
  options.num_threads = 1;
  return options;
}

TEST(WriteSynthClip, WritesWhatTheReadersRead) {
  const TemporaryFolder folder;
  const std::string out = folder.File("a/clip");
  const SynthClipOptions options = Options();
  const SynthClip clip = MakeSynthClip(ToyBody(), DemoMotion(ToyBody(), 8, 10), options);
  WriteSynthClip(out, ToyBody(), clip, options, {.video = true});

  const Track truth = ReadTrack(out + "/truth.npz");
  EXPECT_EQ(truth.num_frames(), 8);
  EXPECT_LT((truth.motion.poses - clip.truth.motion.poses).norm(), 1e-9);
  EXPECT_LT((truth.joints[5] - clip.truth.joints[5]).norm(), 1e-9);
  EXPECT_EQ(truth.camera.width, 160);

  const Track initialiser = ReadTrack(out + "/initialiser.npz");
  EXPECT_LT((initialiser.motion.trans - clip.initialiser.trans).norm(), 1e-9);
  EXPECT_GT((initialiser.motion.trans - truth.motion.trans).norm(), 1e-3);
  EXPECT_GT((initialiser.joints[5] - truth.joints[5]).norm(), 1e-3);

  const DenseSequence dense = ReadDenseObservations(out + "/observations.npz");
  ASSERT_EQ(dense.frames[3].size(), clip.dense.frames[3].size());
  EXPECT_EQ(dense.frames[3][7].face, clip.dense.frames[3][7].face);
  EXPECT_EQ(dense.frames[3][7].pixel, clip.dense.frames[3][7].pixel);

  for (const char* name : {"/observations.npz", "/keypoints.json"}) {
    LoadDetectionsOptions load;
    load.fps = 10;
    const KeypointSequence seen = LoadDetections(out + name, load);
    ASSERT_EQ(seen.num_frames(), 8) << name;
    for (size_t k = 0; k < clip.keypoints.names.size(); ++k) {
      const auto it = std::find(seen.names.begin(), seen.names.end(), clip.keypoints.names[k]);
      ASSERT_NE(it, seen.names.end()) << name << " lacks " << clip.keypoints.names[k];
      const Keypoint &a = seen.at(4, static_cast<int>(it - seen.names.begin())),
                     &b = clip.keypoints.at(4, static_cast<int>(k));
      EXPECT_NEAR(a.confidence, b.confidence, 1e-3);
      if (b.confidence <= 0) continue;
      EXPECT_NEAR(a.x, b.x, 2e-3) << name << " " << *it;
      EXPECT_NEAR(a.y, b.y, 2e-3) << name << " " << *it;
    }
  }

  const std::vector<NamedCamera> cameras = LoadCameras(out + "/cameras.json");
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_NEAR(cameras[0].camera.fx, clip.truth.camera.fx, 1e-9);
  EXPECT_LT((cameras[0].pose.camera_from_world_rotation - clip.camera_from_world.camera_from_world_rotation).norm(),
            1e-9);

  VideoReader video(out + "/video.mp4");
  EXPECT_EQ(video.info().width, 160);
  EXPECT_NEAR(video.info().fps, 10, 1e-6);
  EXPECT_EQ(video.Skip(100), 8);
  EXPECT_NE(ReadFileBytes(out + "/clip.json").find("\"seed\": 1"), std::string::npos);
}

TEST(WriteSynthClip, LeavesOutWhatTheClipLacks) {
  const TemporaryFolder folder;
  SynthClipOptions options = Options();
  options.initialiser_error_px = 0;
  options.dense_per_frame = 0;
  const SynthClip clip = MakeSynthClip(ToyBody(), DemoMotion(ToyBody(), 3, 10), options);
  int calls = 0;
  WriteSynthClip(folder.File("clip"), ToyBody(), clip, options,
                 {.video = true, .progress = [&](double) { return ++calls < 2; }});
  EXPECT_EQ(calls, 2);
  EXPECT_FALSE(fs::exists(folder.File("clip/video.mp4"))) << "stopped: no half-written video";
  EXPECT_FALSE(fs::exists(folder.File("clip/initialiser.npz")));
  EXPECT_TRUE(fs::exists(folder.File("clip/truth.npz")));
  FileErrorOf("dense", [&] { ReadDenseObservations(folder.File("clip/observations.npz")); });
  for (const auto& entry : fs::directory_iterator(folder.File("clip"))) {
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
  }
}

TEST(WriteSynthClip, NamesAFolderThatCannotBeMade) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.File("file"), "in the way");
  const SynthClipOptions options = Options();
  const SynthClip clip = MakeSynthClip(ToyBody(), DemoMotion(ToyBody(), 2, 10), options);
  FileErrorOf(folder.File("file"), [&] { WriteSynthClip(folder.File("file/clip"), ToyBody(), clip, options); });
}

}  // namespace
}  // namespace bodyloom
