// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "geometry/base/hash_random.h"
#include "neural/parser/train_parser.h"

namespace bodyloom::parser_training_test {
namespace {

constexpr uint8_t kTopHere = 1, kBottomHere = 2, kSkinHere = 5;

/// A person of 40×56 pixels in 64×64: a red top down to a line that is another in every picture, skin-coloured below,
/// which the body takes for trousers from row 32 on.
PackedImage RedTop(uint64_t seed) {
  PackedImage image;
  image.width = image.height = 64, image.pixels_per_metre = 100;
  const size_t pixels = image.pixels();
  for (int p = 0; p < kParserPlanes.in; ++p) image.planes.insert(image.planes.end(), pixels, PackPlane(p, 0));
  image.truth.assign(ParserTruth::kCount * pixels, 0);
  const int line = 16 + static_cast<int>(Mix(seed) % 32);
  for (int y = 4; y < 60; ++y) {
    for (int x = 12; x < 52; ++x) {
      const size_t i = static_cast<size_t>(y) * 64 + x;
      const bool top = y < line;
      image.planes[i] = top ? 200 : 180, image.planes[pixels + i] = top ? 20 : 130;
      image.planes[2 * pixels + i] = top ? 30 : 110;
      image.planes[PersonPlane::kAlpha * pixels + i] = 255;
      image.planes[(PersonPlane::kPlace + 1) * pixels + i] =
          PackPlane(PersonPlane::kPlace + 1, static_cast<float>(32 - y) / 64);
      if (x == 12) continue;  // the mask is a column too wide
      image.truth[ParserTruth::kLabel * pixels + i] = top ? kTopHere : kSkinHere;
      image.truth[ParserTruth::kBodyLabel * pixels + i] = y < 32 ? kTopHere : kBottomHere;
    }
  }
  return image;
}

std::vector<PackedImage> RedTops(int first, int count) {
  std::vector<PackedImage> images;
  images.reserve(count);
  for (int i = 0; i < count; ++i) images.push_back(RedTop(first + i));
  return images;
}

TrainParserOptions FewSteps(const std::string& name) {
  TrainParserOptions options;
  options.steps = 120, options.batch = 3, options.crop = 48, options.seed = 7, options.num_threads = 1;
  options.report_every = 10, options.validate_every = 120, options.checkpoint_every = 60, options.warmup_steps = 5;
  options.learning_rate = 3e-3;
  options.run_dir = testing::TempDir() + "parser_" + name;
  std::filesystem::remove_all(options.run_dir);
  std::filesystem::create_directories(options.run_dir);
  return options;
}

TEST(ParserTraining, LearnsByColourWhatTheBodyDoesNotKnow) {
  const TrainParserResult result = TrainParser(RedTops(0, 8), RedTops(100, 4), FewSteps("learns"));
  ASSERT_EQ(result.summary.status, TrainingStatus::kFinished) << result.summary.message;
  EXPECT_GT(result.summary.mean_iou, 0.9);
  EXPECT_LT(result.summary.body_mean_iou, 0.5) << "trousers that nobody wears";
  EXPECT_GT(result.summary.iou[kSkinHere - 1], 0.9);
  EXPECT_EQ(result.summary.body_iou[kBottomHere - 1], 0);
  EXPECT_TRUE(std::isnan(result.summary.iou[3])) << "hair does not occur";
  EXPECT_TRUE(result.weights.IsValid(nullptr));
}

TEST(ParserTraining, PixelsWithoutAPersonDoNotCount) {
  std::vector<PackedImage> images = RedTops(0, 2);
  TrainParserOptions options = FewSteps("count");
  options.steps = options.report_every = 1;
  double loss = -1;
  options.progress = [&loss](const TrainingProgress& progress) {
    loss = progress.At("loss");
    return true;
  };
  TrainParser(images, {}, options);
  EXPECT_NEAR(loss, std::log(kParserClasses), 1e-4) << "an untrained parser knows nothing";
  for (PackedImage& image : images) std::fill(image.truth.begin(), image.truth.end(), uint8_t{0});
  options = FewSteps("count");
  options.steps = options.report_every = 1;
  options.progress = [&loss](const TrainingProgress& progress) {
    loss = progress.At("loss");
    return true;
  };
  TrainParser(images, {}, options);
  EXPECT_EQ(loss, 0);
}

TEST(ParserTraining, GoesOnAsIfItHadNeverStopped) {
  TrainParserOptions whole = FewSteps("whole"), parts = FewSteps("parts");
  whole.steps = parts.steps = 12;
  whole.checkpoint_every = parts.checkpoint_every = 6;
  whole.report_every = parts.report_every = 3;
  const std::vector<PackedImage> train = RedTops(0, 3);
  TrainParser(train, {}, whole);
  parts.progress = [](const TrainingProgress& progress) { return progress.step < 6; };
  EXPECT_EQ(TrainParser(train, {}, parts).summary.status, TrainingStatus::kStopped);
  parts.progress = nullptr;
  parts.resume = true;
  EXPECT_EQ(TrainParser(train, {}, parts).summary.status, TrainingStatus::kFinished);
  EXPECT_EQ(ReadFileBytes(CheckpointPath(whole.run_dir)), ReadFileBytes(CheckpointPath(parts.run_dir)));
}

TEST(ParserTraining, RefusesWhatItCannotUse) {
  EXPECT_THROW(TrainParser({}, {}, FewSteps("none")), std::invalid_argument);
  TrainParserOptions options = FewSteps("odd");
  options.crop = 50;
  EXPECT_THROW(TrainParser(RedTops(0, 1), {}, options), std::invalid_argument);
  std::vector<PackedImage> images = RedTops(0, 1);
  images[0].truth.pop_back();
  EXPECT_THROW(TrainParser(images, {}, FewSteps("short")), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::parser_training_test
