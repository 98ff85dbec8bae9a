// SPDX-License-Identifier: Apache-2.0
// Training of the motion-dependent renderer on toy frames: a square "person" whose colour follows its motion map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/cuda.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "data_tools/descriptors/person_frames.h"
#include "neural/base/image_tensor.h"
#include "neural/base/runtime.h"
#include "neural/motion/motion_model.h"
#include "neural/motion/motion_renderer.h"
#include "neural/motion/motion_scorer.h"
#include "neural/motion/train_motion.h"
#include "neural/training/checkpoint.h"
#include "tests/neural/metrics/named_features.h"
#include "tests/neural/motion/toy_motion.h"
#include "tests/neural/training/last_metrics.h"
#include "tests/support/test_files.h"

namespace bodyloom::motion_training_test {
namespace {

namespace fs = std::filesystem;

TEST(MotionTraining, LearnsFromWhatTheImagesPlaneSays) {
  TrainMotionOptions options = ToyOptions("motion_dense");
  options.config = DenseToy();
  options.config.around_body = true;
  options.reach = 2;
  options.train = options.validation = {{0, 4}};
  options.steps = 250;
  options.learning_rate = 5e-3;
  options.gan_weight = 0;
  options.validate_every = 250;
  const TrainMotionSummary summary = TrainMotion(DenseToyFrame, options);
  ASSERT_EQ(summary.status, TrainingStatus::kFinished) << summary.message;
  EXPECT_LT(summary.scores.image_l1, 0.1);
  // The same network from its file, in the same boxes.
  MotionRenderer renderer(CheckpointPath(options.run_dir), options.config,
                          {.warmup_iterations = 10, .reach = 2, .whole_window = true, .score = true, .num_threads = 1});
  for (int t = 0; t < 4; ++t) {
    MotionFrame frame;
    DenseToyFrame(t, true, &frame);
    renderer.Next(frame);
  }
  EXPECT_NEAR(renderer.scores().image_l1, summary.scores.image_l1, 1e-6);
}

/// Section 4 and eq. 9 of the paper: 512 × 512 pixels, UV maps of 128 × 128, normals and the velocities of ten frames,
/// Adam at 1e-3, batches of 4; λ_s = 10, λ_n = λ_p = 1, λ_g = 0.01. The rest of the profile is this project's choice.
TEST(MotionTraining, SizesAndRatesAreThePublishedOnes) {
  const MotionProfile& paper = MotionProfileNamed("paper");
  EXPECT_EQ(paper.image_size, 512);
  EXPECT_EQ(paper.uv_size, 128);
  EXPECT_EQ(paper.features, 16);
  EXPECT_EQ(paper.texture_size, 512);
  EXPECT_EQ(paper.texture_features, 16);
  EXPECT_EQ(paper.encoder_widths, (std::vector<int>{64, 128, 256}));
  EXPECT_EQ(paper.decoder_widths, (std::vector<int>{64, 128, 256, 512, 512}));
  EXPECT_EQ(paper.discriminator_width, 64);
  EXPECT_EQ(paper.perceptual_divisor, 1);
  EXPECT_EQ(MotionConfig().motion_channels, 3 + 3 * PersonFramesOptions().past);
  EXPECT_EQ(PersonFramesOptions().past, 10);
  const TrainMotionOptions published;
  EXPECT_EQ(published.learning_rate, 1e-3);
  EXPECT_EQ(published.batch, 4);
  EXPECT_EQ(published.shape_weight, 10);
  EXPECT_EQ(published.normal_weight, 1);
  EXPECT_EQ(published.perceptual_weight, 1);
  EXPECT_EQ(published.gan_weight, 0.01);
}

TEST(MotionTraining, LossesAreWeightedAsPublished) {
  TrainMotionOptions options = ToyOptions("motion_weights");
  ASSERT_EQ(TrainMotion(ToyFrame, options).status, TrainingStatus::kFinished);
  std::map<std::string, double> last = LastMetrics(options.run_dir);
  for (const char* term : {"image", "shape", "normals", "perceptual", "generator"}) EXPECT_GT(last[term], 0) << term;
  const double loss =
      last["image"] + 10 * last["shape"] + last["normals"] + last["perceptual"] + 0.01 * last["generator"];
  EXPECT_NEAR(last["loss"], loss, 1e-4 * loss);
}

TEST(MotionTraining, LearnsAClipByHeartAndRollsItOut) {
  TrainMotionOptions options = ToyOptions("motion_learns");
  options.train = options.validation = {{0, 4}};
  options.steps = 250;
  options.learning_rate = 5e-3;
  options.gan_weight = 0;
  options.validate_every = 250;
  std::vector<MotionPreview> previews;
  options.preview = [&](int, const std::vector<MotionPreview>& made) { previews = made; };
  const TrainMotionSummary summary = TrainMotion(ToyFrame, options);
  ASSERT_EQ(summary.status, TrainingStatus::kFinished) << summary.message;
  EXPECT_EQ(summary.scores.frames, 4);
  // An untrained network is off by 0.3 or more, and knows nothing of labels.
  EXPECT_LT(summary.scores.image_l1, 0.1);
  EXPECT_GT(summary.scores.label_iou, 0.7);
  EXPECT_LT(summary.scores.normal_deg, 20);
  EXPECT_TRUE(summary.perceptual_random_features);
  EXPECT_EQ(previews.size(), 4U);
  // The same network from its file, scored apart from training.
  MotionRenderer renderer(CheckpointPath(options.run_dir), options.config,
                          {.warmup_iterations = 10, .score = true, .num_threads = 1});
  for (int t = 0; t < 4; ++t) {
    MotionFrame frame;
    ToyFrame(t, true, &frame);
    renderer.Next(frame);
  }
  const MotionScores again = renderer.scores();
  EXPECT_NEAR(again.image_l1, summary.scores.image_l1, 1e-6);
  EXPECT_NEAR(again.label_iou, summary.scores.label_iou, 1e-6);
}

/// A run of `whole` that is stopped after four steps and goes on, in a folder of this name, ends as the run in
/// whole.run_dir did.
void ExpectResumedEnd(const TrainMotionOptions& whole, const std::string& name) {
  TrainMotionOptions parts = whole;
  parts.run_dir = EmptyFolder(name);
  parts.progress = [](const TrainingProgress& progress) { return progress.step < 4; };
  const TrainMotionSummary stopped = TrainMotion(ToyFrame, parts);
  EXPECT_EQ(stopped.status, TrainingStatus::kStopped);
  EXPECT_EQ(stopped.steps, 4);
  parts.progress = nullptr;
  parts.resume = true;
  ASSERT_EQ(TrainMotion(ToyFrame, parts).status, TrainingStatus::kFinished);
  EXPECT_EQ(FileBytes(CheckpointPath(parts.run_dir)), FileBytes(CheckpointPath(whole.run_dir)));
}

TEST(MotionTraining, AResumedRunEndsWithTheSameBytes) {
  TrainMotionOptions whole = ToyOptions("motion_whole");
  whole.average = 0;
  ASSERT_EQ(TrainMotion(ToyFrame, whole).status, TrainingStatus::kFinished);
  ExpectResumedEnd(whole, "motion_parts");
}

TEST(MotionTraining, TheAverageIsBesideTheLearnerAndIsWhatIsShown) {
  TrainMotionOptions last = ToyOptions("motion_last");
  last.average = 0;
  const TrainMotionSummary raw = TrainMotion(ToyFrame, last);
  TrainMotionOptions whole = ToyOptions("motion_average");
  whole.average = 0.2;
  const TrainMotionSummary averaged = TrainMotion(ToyFrame, whole);
  ASSERT_EQ(averaged.status, TrainingStatus::kFinished);
  EXPECT_NE(averaged.scores.image_l1, raw.scores.image_l1);
  MotionRenderer renderer(CheckpointPath(whole.run_dir), whole.config,
                          {.warmup_iterations = 10, .score = true, .num_threads = 1});
  for (int t = 24; t < 32; ++t) {
    MotionFrame frame;
    ToyFrame(t, true, &frame);
    renderer.Next(frame);
  }
  EXPECT_NEAR(renderer.scores().image_l1, averaged.scores.image_l1, 1e-6);
  // The learner goes the same way as without an average.
  const auto model_of = [](const TrainMotionOptions& options, const char* name) {
    torch::manual_seed(9);
    MotionModel model(options.config);
    Checkpoint checkpoint(ToText(options.config));
    checkpoint.Add(name, model.ptr().get());
    checkpoint.Load(CheckpointPath(options.run_dir), CheckpointPart::kModules);
    return model;
  };
  const auto learner = model_of(whole, "learner")->parameters(), alone = model_of(last, "model")->parameters();
  for (size_t i = 0; i < alone.size(); ++i) ASSERT_TRUE(torch::equal(learner[i], alone[i])) << i;
  ExpectResumedEnd(whole, "motion_average_parts");
}

TEST(MotionTraining, TheLogsLastLineIsOfTheSameFramesAsThoseBeforeIt) {
  TrainMotionOptions options = ToyOptions("motion_quick");
  options.validation = {{0, 60}};
  options.learning_rate = 0;  // nothing changes but what is looked at
  options.average = 0;
  const TrainMotionSummary summary = TrainMotion(ToyFrame, options);
  EXPECT_EQ(summary.scores.frames, 60);
  std::istringstream log(FileBytes((fs::path(options.run_dir) / "metrics.csv").string()));
  std::vector<double> l1;
  for (std::string line, cell; std::getline(log, line);) {
    std::istringstream cells(line);
    for (int i = 0; i < 10; ++i) std::getline(cells, cell, ',');  // step, rate, loss and its five parts, …
    if (!cell.empty() && cell != "validation_l1") l1.push_back(std::stod(cell));
  }
  ASSERT_EQ(l1.size(), 2U);
  EXPECT_EQ(l1[0], l1[1]);
  EXPECT_NE(l1[1], summary.scores.image_l1);
}

TEST(MotionTraining, WherePeopleRarelyAreTheyHaveTheirColourAllTheSame) {
  // The same frame each time; in three of ten its lower half is there.
  const auto source = [](int t, bool with_truth, MotionFrame* frame) {
    ToyFrame(0, with_truth, frame);
    const bool there = (uint32_t(t) * 2654435761U >> 16) % 10 < 3;
    if (!with_truth || there) return;
    for (int i = 16 * 32; i < 32 * 32; ++i) {
      frame->labels[i] = 0;
      for (int c = 0; c < 3; ++c) frame->image[c * 32 * 32 + i] = frame->normals[c * 32 * 32 + i] = 0;
    }
  };
  TrainMotionOptions options = ToyOptions("motion_rarely_there");
  options.validation.clear();
  options.train = {{0, 200}};
  options.rollout_length = 1;
  options.steps = 200;
  options.learning_rate = 5e-3;
  ASSERT_EQ(TrainMotion(source, options).status, TrainingStatus::kFinished);
  MotionRenderer renderer(CheckpointPath(options.run_dir), options.config, {.num_threads = 1});
  MotionFrame frame;
  source(0, false, &frame);
  const MotionImage rendered = renderer.Next(frame);
  double alpha = 0, red = 0;
  for (int y = 18; y < 22; ++y) {
    for (int x = 10; x < 18; ++x) alpha += rendered.alpha[y * 32 + x] / 32, red += rendered.image[y * 32 + x] / 32;
  }
  EXPECT_GT(alpha, 0.1);
  EXPECT_LT(alpha, 0.6);
  EXPECT_NEAR(red / alpha, 0.5, 0.1);
}

TEST(MotionTraining, LossesWithoutTruthAreSwitchedOff) {
  TrainMotionOptions options = ToyOptions("motion_no_truth");
  options.steps = 2;
  options.validation.clear();
  const TrainMotionSummary summary = TrainMotion(
      [](int t, bool with_truth, MotionFrame* frame) {
        ToyFrame(t, with_truth, frame);
        frame->labels.clear();
        frame->normals.clear();
      },
      options);
  EXPECT_EQ(summary.status, TrainingStatus::kFinished);
  EXPECT_EQ(summary.losses_off.size(), 2U);
}

TEST(MotionTraining, ALossThatIsNotANumberKeepsTheLastCheckpoint) {
  TrainMotionOptions options = ToyOptions("motion_nan");
  options.checkpoint_every = 1;
  options.validation.clear();
  options.train = {{0, 24}};
  options.steps = 50;
  const TrainMotionSummary summary = TrainMotion(
      [](int t, bool with_truth, MotionFrame* frame) {
        ToyFrame(t, with_truth, frame);
        if (t == 20 && with_truth) frame->image[600] = std::numeric_limits<float>::quiet_NaN();
      },
      options);
  ASSERT_EQ(summary.status, TrainingStatus::kNotFinite);
  EXPECT_GT(summary.steps, 0);
  EXPECT_NE(summary.message.find("checkpoint.bin holds step " + std::to_string(summary.steps)), std::string::npos)
      << summary.message;
  MotionRenderer renderer(CheckpointPath(options.run_dir), options.config, {.warmup_iterations = 0, .num_threads = 1});
  MotionFrame frame;
  ToyFrame(3, false, &frame);
  for (const float value : renderer.Next(frame).image) ASSERT_TRUE(std::isfinite(value));
}

TEST(MotionTraining, RefusesWhatDoesNotFit) {
  TrainMotionOptions options = ToyOptions("motion_refuses");
  options.train.clear();
  EXPECT_THROW(TrainMotion(ToyFrame, options), std::invalid_argument);
  options = ToyOptions("motion_refuses");
  options.steps = 1;
  ASSERT_EQ(TrainMotion(ToyFrame, options).status, TrainingStatus::kFinished);
  const std::string path = CheckpointPath(options.run_dir);
  MotionConfig other = Toy();
  other.profile.decoder_widths = {4, 8, 8};
  EXPECT_THROW(MotionRenderer(path, other, {.warmup_iterations = 0, .num_threads = 1}), std::runtime_error);
  fs::resize_file(path, fs::file_size(path) / 2);
  try {
    MotionRenderer renderer(path, Toy(), {.warmup_iterations = 0, .num_threads = 1});
    FAIL() << "took half a checkpoint";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path, 0), 0U) << error.what();
  }
}

TEST(MotionTraining, ValidatesWithSsimAndLpips) {
  TrainMotionOptions options = ToyOptions("motion_likeness");
  options.steps = 4;
  options.alexnet = {AlexNetWeights(), "alexnet.pth"};
  options.lpips_heads = {HeadWeights(), "lpips_alex.pth"};
  options.ssim = [](const Image&, const Image&) { return 0.75; };
  const TrainMotionSummary summary = TrainMotion(ToyFrame, options);
  EXPECT_EQ(summary.scores.ssim, 0.75);
  EXPECT_FALSE(summary.scores.lpips_random_features);
  EXPECT_GT(summary.scores.lpips, 0);
  EXPECT_GT(summary.scores.tlpips, 0);
  EXPECT_NE(FileBytes((fs::path(options.run_dir) / "metrics.csv").string()).find("validation_ssim"), std::string::npos);
  // The same from the checkpoint, and without a past the frames still follow each other.
  MotionRenderer renderer(CheckpointPath(options.run_dir), options.config,
                          {.warmup_iterations = 10,
                           .score = true,
                           .lpips = std::make_shared<const Lpips>(LpipsFrom(options.alexnet, options.lpips_heads)),
                           .ssim = options.ssim,
                           .num_threads = 1});
  for (const bool forget : {false, true}) {
    renderer.Restart();
    for (int t = 24; t < 28; ++t) {
      MotionFrame frame;
      ToyFrame(t, true, &frame);
      if (forget) renderer.ForgetPast();
      renderer.Next(frame);
      EXPECT_EQ(std::isnan(renderer.last_scores().tlpips), t == 24);
    }
  }
  EXPECT_EQ(renderer.scores().ssim, 0.75);
  EXPECT_EQ(renderer.scores().frames, 8);
}

TEST(MotionTraining, DoesTheSameOnACard) {
  if (!torch::cuda::is_available()) GTEST_SKIP() << "no CUDA card here";
  TrainMotionOptions options = ToyOptions("motion_cpu");
  const TrainMotionSummary here = TrainMotion(ToyFrame, options);
  TrainMotionOptions other = ToyOptions("motion_cuda");
  other.device = "cuda";
  other.steps = 4;
  other.report_every = other.validate_every = 2;
  ASSERT_EQ(TrainMotion(ToyFrame, other).status, TrainingStatus::kFinished);
  other.steps = options.steps;
  other.resume = true;
  const TrainMotionSummary there = TrainMotion(ToyFrame, other);
  ASSERT_EQ(there.status, TrainingStatus::kFinished) << there.message;
  EXPECT_NEAR(there.scores.image_l1, here.scores.image_l1, 0.02);
  MotionFrame frame;
  ToyFrame(0, false, &frame);
  MotionImage images[2];
  for (const char* device : {"cpu", "cuda"}) {
    MotionRenderer renderer(CheckpointPath(other.run_dir), other.config,
                            {.warmup_iterations = 0, .reach = 3, .num_threads = 1, .device = device});
    images[device[1] == 'u'] = renderer.Next(frame);
  }
  EXPECT_THAT(images[1].image, ::testing::Pointwise(::testing::FloatNear(1e-3F), images[0].image));
  UseNeuralDevice("cpu");
}

}  // namespace
}  // namespace bodyloom::motion_training_test
