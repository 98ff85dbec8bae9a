// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <torch/cuda.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/geometry/base/split_mix.h"
#include "bodyloom/neural/refiner/train_refiner.h"
#include "bodyloom/neural/runtime.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

/// A block of one colour, drawn too dark and two pixels too narrow.
RefinerPicture DarkAndNarrow(uint64_t seed) {
  RefinerPicture picture;
  picture.width = picture.height = 64;
  const size_t pixels = picture.pixels();
  for (int p = 0; p < PersonPlane::kCount; ++p) picture.planes.insert(picture.planes.end(), pixels, PackPlane(p, 0));
  picture.truth.assign(4 * pixels, 0);
  const int x0 = 12 + static_cast<int>(Mix(seed) % 12), x1 = x0 + 24;
  const auto level = static_cast<float>(0.4 + 0.4 * UniformOf(Mix(seed + 1000)));
  for (int y = 8; y < 56; ++y) {
    for (int x = 0; x < 64; ++x) {
      const size_t i = static_cast<size_t>(y) * 64 + x;
      for (int c = 0; c < 3; ++c) picture.planes[c * pixels + i] = PackPlane(c, 0.8F * level);
      if (x >= x0 + 2 && x < x1 - 2) picture.planes[3 * pixels + i] = 255;
      if (x < x0 || x >= x1) continue;
      for (int c = 0; c < 3; ++c) picture.truth[c * pixels + i] = PackPlane(c, level);
      picture.truth[3 * pixels + i] = 255;
    }
  }
  return picture;
}

std::vector<RefinerPicture> Pictures(int first, int count) {
  std::vector<RefinerPicture> pictures;
  pictures.reserve(count);
  for (int i = 0; i < count; ++i) pictures.push_back(DarkAndNarrow(first + i));
  return pictures;
}

TrainRefinerOptions SmallOptions(const std::string& name) {
  TrainRefinerOptions options;
  options.steps = 60, options.batch = 2, options.crop = 64, options.seed = 7, options.num_threads = 1;
  options.report_every = 10, options.validate_every = 60, options.checkpoint_every = 20, options.warmup_steps = 5;
  options.learning_rate = 3e-3;
  options.run_dir = (fs::path(testing::TempDir()) / ("refiner_" + name)).string();
  fs::remove_all(options.run_dir);
  fs::create_directories(options.run_dir);
  return options;
}

TEST(RefinerTraining, LearnsWhatIsAlwaysWrong) {
  TrainRefinerOptions options = SmallOptions("learns");
  options.light_strength = 0, options.perceptual_weight = 0;
  options.steps = options.validate_every = 150, options.batch = 4, options.learning_rate = 2e-3;
  const TrainRefinerResult result = TrainRefiner(Pictures(0, 6), Pictures(100, 3), options);
  ASSERT_EQ(result.summary.status, TrainingStatus::kFinished) << result.summary.message;
  EXPECT_GT(result.summary.refined_psnr_db, result.summary.drawn_psnr_db + 2);
  EXPECT_TRUE(result.weights.IsValid(nullptr));
}

TEST(RefinerTraining, TheLightOfACropIsOnDrawingAndTruthAlike) {
  std::vector<RefinerPicture> pictures = Pictures(0, 2);
  for (RefinerPicture& picture : pictures) {  // drawn as it is: nothing to learn in any light
    std::copy(picture.truth.begin(), picture.truth.end(), picture.planes.begin());
  }
  TrainRefinerOptions options = SmallOptions("light");
  options.steps = options.report_every = 1, options.perceptual_weight = 0, options.light_strength = 1;
  double loss = -1;
  options.progress = [&loss](const TrainRefinerProgress& progress) {
    loss = progress.loss;
    return true;
  };
  TrainRefiner(pictures, {}, options);
  EXPECT_GE(loss, 0);
  EXPECT_LT(loss, 1e-6);
}

TEST(RefinerTraining, GoesOnAsIfItHadNeverStopped) {
  TrainRefinerOptions whole = SmallOptions("whole"), parts = SmallOptions("parts");
  whole.steps = parts.steps = 24;
  whole.checkpoint_every = parts.checkpoint_every = 12;
  whole.report_every = parts.report_every = 6;
  const std::vector<RefinerPicture> train = Pictures(0, 4);
  TrainRefiner(train, {}, whole);
  parts.progress = [](const TrainRefinerProgress& progress) { return progress.step < 12; };
  EXPECT_EQ(TrainRefiner(train, {}, parts).summary.status, TrainingStatus::kStopped);
  parts.progress = nullptr;
  parts.resume = true;
  EXPECT_EQ(TrainRefiner(train, {}, parts).summary.status, TrainingStatus::kFinished);
  EXPECT_EQ(ReadFileBytes(CheckpointPath(whole.run_dir)), ReadFileBytes(CheckpointPath(parts.run_dir)));
}

TEST(RefinerTraining, RefusesWhatItCannotUse) {
  EXPECT_THROW(TrainRefiner({}, {}, SmallOptions("none")), std::invalid_argument);
  TrainRefinerOptions options = SmallOptions("odd");
  options.crop = 50;
  std::string why;
  EXPECT_FALSE(options.IsValid(&why));
  EXPECT_EQ(why, "crop is 50, expected a multiple of 16");
  std::vector<RefinerPicture> pictures = Pictures(0, 1);
  pictures[0].truth.pop_back();
  EXPECT_THROW(TrainRefiner(pictures, {}, SmallOptions("short")), std::invalid_argument);
}

TEST(RefinerTraining, LearnsTheSameOnACard) {
  if (!torch::cuda::is_available()) GTEST_SKIP() << "no CUDA card here";
  TrainRefinerOptions options = SmallOptions("card");
  const TrainRefinerResult here = TrainRefiner(Pictures(0, 6), Pictures(100, 3), options);
  options = SmallOptions("card");
  options.device = "cuda";
  const TrainRefinerResult there = TrainRefiner(Pictures(0, 6), Pictures(100, 3), options);
  EXPECT_NEAR(there.summary.refined_psnr_db, here.summary.refined_psnr_db, 1.5);
  UseNeuralDevice("cpu");
}

}  // namespace
}  // namespace bodyloom
