// SPDX-License-Identifier: Apache-2.0
#include "pipelines/video/track_video.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/data_tools/video/clip_maker.h"

namespace bodyloom::track_video_test {
namespace {

Track TrackOf(int width, int height) {
  Track track;
  track.camera = MakePinhole(width, height, 100);
  track.motion.timestamps = {0, 1.0 / 30};
  return track;
}

/// Index of TrackVideo's frame at a time, -1 for none.
int ShownAt(TrackVideo& video, double time_s) {
  const Image* image = video.At(time_s);
  return image == nullptr ? -1 : NumberOf(*image);
}

TEST(TrackVideo, FramesOfAVariableRateAreFoundByTheirTimes) {
  const TemporaryFolder folder;
  const std::string path = folder.File("variable.mp4");
  // Frames 0 to 5 at 1/30 s each, 6 to 11 at 1/10 s: 0, 0.033 ... 0.167, 0.2, 0.3, ... 0.7.
  Ffmpeg(NumberedInput(folder, 12) + "-vf \"setpts='if(lt(N,6),N,6+3*(N-6))/30/TB'\" -vsync vfr -pix_fmt yuv420p " +
         path);
  const ReadClip clip = ReadAll(path);
  ASSERT_EQ(clip.times.size(), 12U);
  ASSERT_NEAR(clip.times[11], 0.7, 1e-3);
  TrackVideo video(path, TrackOf(96, 64));
  EXPECT_EQ(ShownAt(video, -0.5), -1) << "before the beginning";
  EXPECT_EQ(ShownAt(video, 0), 0);
  EXPECT_EQ(ShownAt(video, 0.07), 2);
  EXPECT_EQ(ShownAt(video, 0.2), 6);
  EXPECT_EQ(ShownAt(video, 0.39), 8);
  EXPECT_EQ(ShownAt(video, 0.62), 10);
  EXPECT_EQ(video.FramesAfter(0.62), 1);
  EXPECT_EQ(ShownAt(video, 0.7), 11);
  EXPECT_EQ(ShownAt(video, 1.5), -1) << "past the end";
}

TEST(TrackVideo, TheOffsetIsAFrameOfTheVideo) {
  const TemporaryFolder folder;
  const std::string path = folder.File("even.mp4");
  Ffmpeg(NumberedInput(folder, 10) + "-pix_fmt yuv420p " + path);
  TrackVideo late(path, TrackOf(96, 64), NamedCamera().video_px_from_camera_px, 3);
  EXPECT_EQ(ShownAt(late, 0), 3);
  EXPECT_EQ(ShownAt(late, 2.0 / 30), 5);
  EXPECT_EQ(ShownAt(late, 8.0 / 30), -1);
  TrackVideo early(path, TrackOf(96, 64), NamedCamera().video_px_from_camera_px, -2);
  EXPECT_EQ(ShownAt(early, 1.0 / 30), -1);
  EXPECT_EQ(ShownAt(early, 4.0 / 30), 2);
}

TEST(TrackVideo, AFolderOfImagesHasTheTracksRate) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.File("frames"));
  for (int i = 0; i < 4; ++i) {
    WriteImage(folder.File("frames/" + std::to_string(i) + ".png"), NumberedImage(i));
  }
  TrackVideo video(folder.File("frames"), TrackOf(96, 64));
  EXPECT_EQ(ShownAt(video, 2.0 / 30), 2);
  EXPECT_EQ(ShownAt(video, 4.0 / 30), -1);
}

}  // namespace
}  // namespace bodyloom::track_video_test
