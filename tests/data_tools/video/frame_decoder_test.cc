// SPDX-License-Identifier: Apache-2.0
// Interlaced videos against the progressive pictures of which they were made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cstdint>
#include <limits>
#include <optional>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "data_tools/video/frame_decoder.h"

#include "data_tools/video/video_reader.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/video/clip_maker.h"

namespace bodyloom::frame_decoder_test {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 160, kHeight = 96;

/// A bright blob with soft edges that goes 3 pixels to the right in each field.
Image Moving(int field) {
  Image image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double d = std::hypot(x - 30 - 3.0 * field, y - 48.0);
      const auto grey = uint8_t(std::lround(40 + 160 / (1 + std::exp(0.5 * (d - 20)))));
      std::fill_n(image.pixel(x, y), 3, grey);
    }
  }
  return image;
}

/// Fields at 60 a second become frames at 30 a second, the upper field first or the lower one.
std::string Interlaced(const TemporaryFolder& folder, int num_fields, bool upper_first, const std::string& codec) {
  for (int i = 0; i < num_fields; ++i) WriteImage(folder.File("f" + std::to_string(1000 + i) + ".png"), Moving(i));
  const std::string path = folder.File(upper_first ? "upper.mkv" : "lower.mkv");
  Ffmpeg("-framerate 60 -start_number 1000 -i " + folder.File("f%d.png") + " -vf \"tinterlace=" +
         (upper_first ? "interleave_top,fieldorder=tff" : "interleave_bottom,fieldorder=bff") + "\" " + codec + path);
  return path;
}

constexpr const char* kH264 = "-c:v libx264 -qp 1 -pix_fmt yuv420p -flags +ildct+ilme ";

TEST(Deinterlacer, PicturesAreThoseOfTheFirstField) {
  const TemporaryFolder folder;
  for (const bool upper_first : {true, false}) {
    const std::string path = Interlaced(folder, 24, upper_first, kH264);
    VideoReader reader(path);
    Image frame;
    int frames = 0;
    for (; reader.Read(&frame); ++frames) {
      EXPECT_NEAR(reader.frame_time(), frames / 30.0, 2e-3);
      const double own = MeanDifference(frame, Moving(2 * frames)),
                   other = MeanDifference(frame, Moving(2 * frames + 1));
      EXPECT_LT(own, 1.5) << "frame " << frames;
      EXPECT_GT(other, 2 * own) << "frame " << frames;
    }
    EXPECT_EQ(frames, 12);
    EXPECT_THAT(reader.note(), HasSubstr("interlaced"));
    EXPECT_EQ(reader.warning(), "");
    EXPECT_EQ(VideoFrameTimes(path).size(), 12U);
  }
}

TEST(Deinterlacer, SkippedFramesAndASingleOneKeepTheirPlaces) {
  const TemporaryFolder folder;
  const std::string path = Interlaced(folder, 24, true, kH264);
  VideoReader reader(path);
  EXPECT_EQ(reader.Skip(7), 7);
  Image frame;
  ASSERT_TRUE(reader.Read(&frame));
  EXPECT_LT(MeanDifference(frame, Moving(14)), 1.5);
  EXPECT_NEAR(reader.frame_time(), 7 / 30.0, 2e-3);
  EXPECT_EQ(reader.Skip(100), 4) << "to the end";

  const TemporaryFolder alone;
  VideoReader one(Interlaced(alone, 2, true, kH264));
  ASSERT_TRUE(one.Read(&frame));
  EXPECT_LT(MeanDifference(frame, Moving(0)), 2);
  EXPECT_FALSE(one.Read(&frame));
}

TEST(Deinterlacer, OldCodecsAndNonSquarePixelsTogether) {
  const TemporaryFolder folder;
  const std::string path =
      Interlaced(folder, 20, true, "-c:v mpeg2video -q:v 1 -flags +ildct+ilme -aspect 20:9 -f matroska ");
  VideoReader reader(path);
  EXPECT_EQ(reader.info().width, 213) << "pixels of 4:3";
  EXPECT_EQ(reader.info().height, kHeight);
  EXPECT_THAT(reader.note(), HasSubstr("interlaced, each frame is made of its first field; its pixels are not square"));
}

TEST(Deinterlacer, ProgressiveVideosPassUnchanged) {
  const TemporaryFolder folder;
  Ffmpeg(NumberedInput(folder, 6) + "-c:v libx264 -qp 4 -pix_fmt yuv420p " + folder.File("p.mp4"));
  VideoReader reader(folder.File("p.mp4"));
  Image frame;
  while (reader.Read(&frame)) {
  }
  EXPECT_EQ(reader.note(), "");
}

constexpr double kFrame = 0.04;

std::vector<double> TimesOf(const std::vector<std::optional<int64_t>>& timestamps) {
  FrameClock clock(1, 1000, kFrame);
  std::vector<double> times;
  times.reserve(timestamps.size());
  for (const auto& timestamp : timestamps) times.push_back(clock.Next(timestamp));
  return times;
}

void ExpectTimes(const std::vector<std::optional<int64_t>>& timestamps, const std::vector<double>& expected) {
  const std::vector<double> times = TimesOf(timestamps);
  ASSERT_EQ(times.size(), expected.size());
  for (size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], expected[i], 1e-12) << "frame " << i;
}

TEST(FrameClock, CountsFromTheFirstFrame) { ExpectTimes({500, 533, 650, 651}, {0, 0.033, 0.15, 0.151}); }

TEST(FrameClock, NegativeTimestampsAreTimestamps) { ExpectTimes({-80, -40, 0}, {0, 0.04, 0.08}); }

TEST(FrameClock, FillsInWhatIsMissing) {
  ExpectTimes({100, std::nullopt, 200, std::nullopt}, {0, kFrame, 0.1, 0.1 + kFrame});
  ExpectTimes({std::nullopt, std::nullopt, 700, 800}, {0, kFrame, 2 * kFrame, 2 * kFrame + 0.1});
}

TEST(FrameClock, AFrameIsNeverBeforeAnother) {
  ExpectTimes({0, 40, 40, 80}, {0, 0.04, 0.04 + kFrame / 2, 0.08});
  ExpectTimes({0, 500, 460, 540}, {0, 0.5, 0.5 + kFrame / 2, 0.54});
}

TEST(FrameClock, GoesOnWhereARecordingBeginsAnew) {
  ExpectTimes({0, 2000, 0, 30, 90}, {0, 2, 2 + kFrame, 2.03 + kFrame, 2.09 + kFrame});
}

TEST(FrameClock, TimestampsAtTheEdgeOfTheirRange) {
  constexpr int64_t kMinimum = std::numeric_limits<int64_t>::min() + 1, kMaximum = std::numeric_limits<int64_t>::max();
  const std::vector<double> times = TimesOf({kMinimum, kMaximum, 0, kMaximum, kMinimum, kMaximum});
  for (size_t i = 1; i < times.size(); ++i) EXPECT_GE(times[i], times[i - 1]);
}

}  // namespace

}  // namespace bodyloom::frame_decoder_test
