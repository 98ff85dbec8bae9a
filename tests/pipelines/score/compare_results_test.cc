// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "pipelines/score/compare_results.h"

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/evaluation/image_metrics.h"
#include "data_tools/video/image_file.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"
#include "tests/support/test_files.h"

namespace bodyloom::compare_results_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Image Grey(int value) {
  const auto v = static_cast<uint8_t>(value);
  return Image(40, 30, {v, v, v});
}

class CompareResultsTest : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_ / name; }
  /// FOLDER/000000.png, … one grey picture a value.
  std::string Images(const std::string& folder, const std::vector<int>& values) const {
    fs::create_directories(Path(folder));
    for (size_t i = 0; i < values.size(); ++i) {
      char name[32];
      std::snprintf(name, sizeof name, "/%06zu.png", i);
      WriteImage(Path(folder) + name, Grey(values[i]));
    }
    return Path(folder);
  }

  ScratchFolder folder_;
};

TEST_F(CompareResultsTest, FurtherMetricsSeeFramesInOrder) {
  CompareResultsRequest request;
  request.truth = Images("truth", {10, 20, 30, 40, 50});
  request.result = Images("result", {11, 21, 31, 41, 51});
  request.num_threads = 2;
  request.csv = Path("m.csv");
  FrameMetric change;
  change.columns = {{"change", "of the result since the frame before"}, {"level", "of the truth"}};
  change.compute = [](const FramePair& frame, const FramePair* before) {
    const double here = frame.result.at(0, 0).red;
    return std::vector<double>{before == nullptr ? std::nan("") : here - before->result.at(0, 0).red,
                               double(frame.truth.at(0, 0).red)};
  };
  request.more = {change};
  const CompareResultsReport report = CompareResults(request);
  const MetricTable& table = report.tables.at(0);
  ASSERT_EQ(table.columns.size(), 4U);
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(table.rows[i].values[3], 10.0 * (i + 1));
    if (i > 0) {
      EXPECT_EQ(table.rows[i].values[2], 10);
    }
  }
  const ColumnSummary summary = Summarise(table, 2);
  EXPECT_EQ(summary.finite, 4);
  EXPECT_EQ(summary.undefined, 1);
  EXPECT_EQ(summary.std, 0);
  EXPECT_THAT(FileBytes(Path("m.csv")), HasSubstr("frame,psnr_db,ssim_wang2004,change,level\n"));
  request.more.front().compute = [](const FramePair&, const FramePair*) { return std::vector<double>{1}; };
  EXPECT_THROW(CompareResults(request), std::runtime_error);
}

/// 1 where a frame has one before it to follow.
FrameMetric Follows() {
  FrameMetric metric;
  metric.columns = {{"follows", "another frame"}};
  metric.compute = [](const FramePair&, const FramePair* before) {
    return std::vector<double>{before != nullptr ? 1.0 : 0.0};
  };
  return metric;
}

std::vector<int> FollowersOf(const std::string& truth, const std::string& result, bool common_only = false) {
  CompareResultsRequest request;
  request.truth = truth, request.result = result, request.common_only = common_only;
  request.num_threads = 2;
  request.more = {Follows()};
  std::vector<int> follows;
  const auto summary = CompareResults(request);
  for (const MetricRow& row : summary.tables.at(0).rows) {
    follows.push_back(static_cast<int>(row.values.back()));
  }
  return follows;
}

TEST_F(CompareResultsTest, AFrameFollowsAnotherWhereItsNumberDoes) {
  const std::string truth = Images("truth", {1, 2, 3, 4, 5, 6, 7}), result = Images("result", {1, 2, 3, 4, 5, 6, 7});
  EXPECT_EQ(FollowersOf(truth, result), (std::vector<int>{0, 1, 1, 1, 1, 1, 1}));
  fs::remove(Path("result") + "/000002.png");
  fs::remove(Path("result") + "/000003.png");
  EXPECT_EQ(FollowersOf(truth, result, true), (std::vector<int>{0, 1, 0, 1, 1})) << "frames 2 and 3 are not there";
  // Every second frame of a clip is no clip of gaps.
  for (const char* gone : {"/000001.png", "/000005.png"}) fs::remove(Path("result") + gone);
  Images("result", {1});
  WriteImage(Path("result") + "/000002.png", Grey(3));
  EXPECT_EQ(FollowersOf(truth, result, true), (std::vector<int>{0, 1, 1, 1}));
  for (const char* side : {"a", "b"}) {
    fs::create_directories(Path(side));
    for (const char* name : {"/first.png", "/second.png"}) WriteImage(Path(side) + name, Grey(3));
  }
  EXPECT_EQ(FollowersOf(Path("a"), Path("b")), (std::vector<int>{0, 1})) << "names without numbers, as sorted";
}

TEST_F(CompareResultsTest, AFrameFollowsNoneAcrossACutOfItsClip) {
  Track track = ShortTrack();
  for (int t = 5; t < track.num_frames(); ++t) track.motion.timestamps[t] += 3;
  SinglePersonDatasetInfo info;
  info.num_frames = track.num_frames(), info.width = track.camera.width, info.height = track.camera.height;
  info.has = {false, false, false, false};
  const SinglePersonDatasetWriter writer(Path("set"), info, track);
  PersonFrame frame;
  frame.rgb = Image(info.width, info.height);
  for (int t = 0; t < info.num_frames; ++t) writer.Write(t, frame);
  writer.Finish();
  std::vector<int> expected(info.num_frames, 1);
  expected[0] = expected[5] = 0;
  EXPECT_EQ(FollowersOf(Path("set"), Path("set")), expected);
  EXPECT_EQ(FollowersOf(Path("set/images"), Path("set/images")), expected) << "the images of a set are of its clip";
}

TEST_F(CompareResultsTest, ACancelledComparisonWritesNothing) {
  CompareResultsRequest request;
  request.truth = Images("truth", {10, 20});
  request.result = Images("result", {11, 21});
  request.json = Path("m.json");
  PipelineCallbacks callbacks;
  std::vector<std::string> stages;
  callbacks.progress = [&](const std::string& stage, double) {
    stages.push_back(stage);
    return false;
  };
  EXPECT_THROW(CompareResults(request, callbacks), Cancelled);
  EXPECT_EQ(stages, std::vector<std::string>{"images"});
  EXPECT_FALSE(fs::exists(request.json));
}

Image Noise(int width, int height, int seed) {
  std::mt19937 random(seed);
  Image image(width, height);
  for (uint8_t& byte : image.bgr) byte = static_cast<uint8_t>(random() % 256);
  return image;
}

TEST(ErrorImages, PixelErrorsAreThoseOfPsnr) {
  const Image truth = Noise(40, 30, 1), result = Noise(40, 30, 2);
  double squares = 0;
  for (const float e : PixelErrors(truth, result)) squares += double{e} * e;
  EXPECT_NEAR(10 * std::log10(255 * 255 / (squares / (40 * 30))), Psnr(truth, result), 1e-5);
  Image one(2, 1, {10, 20, 30}), other = one;
  other.pixel(1, 0)[0] = 33, other.pixel(1, 0)[1] = 16;  // 3 more blue, 4 less green
  EXPECT_EQ(PixelErrors(one, other)[0], 0);
  EXPECT_NEAR(PixelErrors(one, other)[1], 5 / std::sqrt(3.0), 1e-6);
  EXPECT_THROW(PixelErrors(one, Noise(1, 2, 1)), std::invalid_argument);
}

TEST(ErrorImages, TruthResultAndErrorStandSideBySide) {
  for (const int width : {200, 40}) {  // a wide picture, and one in a wider cell
    const Image truth = Noise(width, 90, 3), result = Noise(width, 90, 4);
    const std::vector<float> errors = PixelErrors(truth, result);
    const Image image = ErrorImage(truth, result, {100, "grey levels", "error"});
    const int cell = std::max(width, 150), top = static_cast<int>(std::lround(2.4 * std::max(7.0, cell / 36.0)));
    EXPECT_EQ(image.width, 3 * cell + 24);
    for (int y = 0; y < 90; y += 7) {
      for (int x = 0; x < width; x += 3) {
        ASSERT_EQ(image.at(6 + x, top + y), truth.at(x, y));
        ASSERT_EQ(image.at(12 + cell + x, top + y), result.at(x, y));
        ASSERT_EQ(image.at(18 + 2 * cell + x, top + y), ErrorColour(errors[y * width + x] / 100));
      }
    }
    // Below the error alone: the legend, with the last colour at the bar's right end.
    bool has_yellow = false;
    for (int y = top + 90; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        has_yellow |= image.at(x, y) == ErrorColour(1);
        if (x < 12 + 2 * cell) {
          ASSERT_EQ(image.at(x, y), image.at(0, 0));
        }
      }
    }
    EXPECT_TRUE(has_yellow);
  }
}

TEST(ErrorImages, OneIsWrittenForEveryFrame) {
  const ScratchFolder folder;
  for (const char* side : {"truth", "result"}) {
    std::filesystem::create_directories(folder / side);
    for (const char* name : {"/a.png", "/b.png", "/c.png"}) {
      WriteImage(folder / side + name, Noise(50, 40, side[0] + name[1]));
    }
  }
  CompareResultsRequest request;
  request.truth = folder / "truth", request.result = folder / "result";
  request.pictures = folder / "errors/of/run";
  request.error_maximum = 128;
  request.num_threads = 2;
  const CompareResultsReport report = CompareResults(request);
  EXPECT_EQ(report.tables.at(0).columns.size(), 2u) << "pictures are no column";
  for (const std::string name : {"a", "b", "c"}) {
    EXPECT_EQ(ReadImage(request.pictures + "/" + name + ".png"),
              ErrorImage(ReadImage(request.truth + "/" + name + ".png"),
                         ReadImage(request.result + "/" + name + ".png"), {128, "grey levels", "error of a pixel"}));
  }
  request.pictures = request.truth;
  EXPECT_THROW(CompareResults(request), RequestError) << "they would take the place of what is compared";
}

}  // namespace

}  // namespace bodyloom::compare_results_test
