// SPDX-License-Identifier: Apache-2.0
#include "pipelines/score/compare_results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "data_tools/evaluation/image_metrics.h"
#include "data_tools/video/image_file.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::error_images_test {
namespace {

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
}  // namespace bodyloom::error_images_test
