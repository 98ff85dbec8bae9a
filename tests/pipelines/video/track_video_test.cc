// SPDX-License-Identifier: Apache-2.0
#include "pipelines/video/track_video.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "data_tools/video/frame_image.h"
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

TEST(TrackVideo, SlowMotionAndTurnsAreThoseOfTheTrack) {
  const TemporaryFolder folder;
  const std::string path = folder.File("slow.mp4");
  Ffmpeg(NumberedInput(folder, 16) + "-c:v libx264rgb -qp 0 " + path);
  Track track = TrackOf(64, 96);
  track.playback = {90, 8};
  track.motion.timestamps = {0, 1.0 / 240};
  TrackVideo video(path, track);
  EXPECT_EQ(video.info().width, 64);
  EXPECT_EQ(*video.At(0), Oriented(NumberedImage(0), ClockwiseTurn(90)));
  EXPECT_EQ(*video.At(5.0 / 240), Oriented(NumberedImage(5), ClockwiseTurn(90)));
  EXPECT_EQ(video.FramesAfter(5.0 / 240), 10);
  EXPECT_EQ(video.At(16.5 / 240), nullptr);
  EXPECT_EQ(PlaybackOf(video.info(), 90, 240), track.playback);
  EXPECT_EQ(PlaybackOf(VideoInfo{}, 0, 240, 60).slowdown, 4) << "images at 60 a second";
  EXPECT_EQ(PlaybackOf(VideoInfo{}, 0, 240).slowdown, 8);
  EXPECT_EQ(PlaybackOf(video.info(), 0, 0), VideoPlayback());
}

TEST(TrackVideo, CamerasOfStoredOrSquarePixels) {
  VideoInfo video;
  video.width = 1024, video.height = 576, video.stored_width = 720, video.stored_height = 576;
  const Matrix2x3d none = NamedCamera().video_px_from_camera_px;
  const auto map = [&](int width, int height) {
    return VideoFromCameraPixels(none, MakePinhole(width, height, 900), video, "dv.avi");
  };
  EXPECT_TRUE(map(1024, 576).isApprox(none));
  EXPECT_TRUE(map(720, 576).isApprox(ScaleOfPixels({720, 576}, {1024, 576})));
  EXPECT_TRUE(map(360, 288).isApprox(ScaleOfPixels({360, 288}, {1024, 576})));
  // The corners of the images meet: (−0.5, −0.5), and (719.5, 575.5) with (1023.5, 575.5).
  EXPECT_TRUE((map(720, 576) * Eigen::Vector3d(-0.5, -0.5, 1)).isApprox(Eigen::Vector2d(-0.5, -0.5)));
  EXPECT_TRUE((map(720, 576) * Eigen::Vector3d(719.5, 575.5, 1)).isApprox(Eigen::Vector2d(1023.5, 575.5)));
  EXPECT_THROW(map(640, 360 * 2), std::runtime_error);
  Camera weak = MakePinhole(720, 576, 900);
  weak.model = CameraModel::kWeakPerspective;
  EXPECT_THROW(VideoFromCameraPixels(none, weak, video, "dv.avi"), std::runtime_error);
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
