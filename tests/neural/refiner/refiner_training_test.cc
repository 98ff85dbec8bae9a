// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <torch/cuda.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/geometry/base/split_mix.h"
#include "bodyloom/neural/refiner/train_refiner.h"
#include "bodyloom/neural/runtime.h"
#include "bodyloom/pipelines/person/picture_refiner.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

/// A block of one colour, drawn too dark and two pixels too narrow.
PackedPicture DarkAndNarrow(uint64_t seed) {
  PackedPicture picture;
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

std::vector<PackedPicture> Pictures(int first, int count) {
  std::vector<PackedPicture> pictures;
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
  options.moves_outline = true;
  options.light_strength = 0, options.perceptual_weight = 0;
  options.steps = options.validate_every = 150, options.batch = 4, options.learning_rate = 2e-3;
  const TrainRefinerResult result = TrainRefiner(Pictures(0, 6), Pictures(100, 3), options);
  ASSERT_EQ(result.summary.status, TrainingStatus::kFinished) << result.summary.message;
  EXPECT_GT(result.summary.refined_psnr_db, result.summary.drawn_psnr_db + 2);
  EXPECT_TRUE(result.weights.IsValid(nullptr));
}

TEST(RefinerTraining, ColoursAloneAreLearnedWhereThePersonIs) {
  TrainRefinerOptions options = SmallOptions("colours");
  options.light_strength = 0, options.perceptual_weight = 0;
  options.steps = options.validate_every = 150, options.batch = 4, options.learning_rate = 2e-3;
  std::vector<PackedPicture> pictures = Pictures(0, 6);
  // Six rows are drawn that are nobody's: their colour is to stay.
  constexpr size_t kRow = 64, kFirst = 50 * kRow, kEnd = 56 * kRow;
  for (PackedPicture& picture : pictures) {
    for (size_t p = 0; p < 4; ++p) {
      std::fill_n(picture.truth.begin() + static_cast<std::ptrdiff_t>(p * picture.pixels() + kFirst), kEnd - kFirst, 0);
    }
  }
  const TrainRefinerResult result = TrainRefiner(pictures, {pictures[0]}, options);
  ASSERT_EQ(result.summary.status, TrainingStatus::kFinished) << result.summary.message;
  EXPECT_FALSE(result.weights.moves_outline);
  PersonLayers layers;
  layers.width = layers.height = 64;
  const PackedPicture& picture = pictures[1];
  for (size_t i = 0; i < picture.planes.size(); ++i) {
    const PlanePacking packing = PackingOf(static_cast<int>(i / picture.pixels()));
    layers.planes.push_back((static_cast<float>(picture.planes[i]) - packing.offset) / packing.scale);
  }
  RefinerWeights weights = result.weights;
  weights.pixels_per_metre = 1;
  const std::vector<float> person = ChangedPerson(layers, PictureRefiner(weights).Change(layers));
  // Means over what is drawn of rows 20 to 40, and of the rows that are nobody's.
  const auto mean_change = [&](size_t first, size_t end) {
    double sum = 0, count = 0;
    for (size_t i = first; i < end; ++i) {
      if (layers.planes[3 * layers.pixels() + i] == 0) continue;
      sum += person[i] - layers.planes[i], ++count;
    }
    return sum / count;
  };
  const double of_person = mean_change(20 * kRow, 40 * kRow), of_nobody = mean_change(kFirst + kRow, kEnd - kRow);
  const double missing = 0.25 * layers.planes[32 * kRow + 32];  // drawn with 0.8 of its colour
  EXPECT_NEAR(of_person, missing, 0.3 * missing);
  EXPECT_LT(std::abs(of_nobody), 0.5 * missing);
  for (size_t i = 3 * layers.pixels(); i < person.size(); ++i) ASSERT_EQ(person[i], layers.planes[i]);
}

TEST(RefinerTraining, TheLightOfACropIsOnDrawingAndTruthAlike) {
  std::vector<PackedPicture> pictures = Pictures(0, 2);
  for (PackedPicture& picture : pictures) {  // drawn as it is: nothing to learn in any light
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
  const std::vector<PackedPicture> train = Pictures(0, 4);
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
  std::vector<PackedPicture> pictures = Pictures(0, 1);
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
