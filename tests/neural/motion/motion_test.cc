// SPDX-License-Identifier: Apache-2.0
// The motion-dependent renderer on toy frames: a square "person" whose colour follows its motion map.
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

#include "bodyloom/data_tools/descriptors/person_frames.h"
#include "bodyloom/neural/image_tensor.h"
#include "bodyloom/neural/motion/clothes_reach.h"
#include "bodyloom/neural/motion/frame_tensors.h"
#include "bodyloom/neural/motion/motion_card.h"
#include "bodyloom/neural/motion/motion_model.h"
#include "bodyloom/neural/motion/motion_renderer.h"
#include "bodyloom/neural/motion/motion_scorer.h"
#include "bodyloom/neural/motion/roll_out.h"
#include "bodyloom/neural/motion/train_motion.h"
#include "bodyloom/neural/networks/architecture_card.h"
#include "bodyloom/neural/runtime.h"
#include "bodyloom/neural/training/checkpoint.h"
#include "tests/neural/metrics/named_features.h"
#include "tests/neural/motion/toy_motion.h"
#include "tests/neural/training/last_metrics.h"
#include "tests/support/paths.h"
#include "tests/support/test_files.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using torch::Tensor;

int64_t Parameters(const torch::nn::Module& module) {
  int64_t count = 0;
  for (const Tensor& parameter : module.parameters()) count += parameter.numel();
  return count;
}

TEST(MotionModel, ProfilesHaveTheSizesThatTheyAreKnownFor) {
  // Computed apart from this code for the paper's blocks: base 64 with five levels 5.8 M, 45.8 M and 45.8 M; base 16
  // with four 0.37 M, 1.5 M and 1.5 M; base 8 0.09 M, 0.37 M, 0.37 M.
  const auto millions = [](const char* profile) {
    MotionConfig config;
    config.profile = MotionProfileNamed(profile);
    const MotionModel model(config);
    return std::vector<double>{1e-6 * Parameters(*model->encoder), 1e-6 * Parameters(*model->shape_decoder),
                               1e-6 * Parameters(*model->appearance_decoder)};
  };
  const std::vector<double> cpu = millions("cpu"), tiny = millions("tiny");
  EXPECT_NEAR(cpu[0], 0.37, 0.01);
  EXPECT_NEAR(cpu[1], 1.5, 0.05);
  EXPECT_NEAR(cpu[2], 1.5, 0.05);
  EXPECT_NEAR(tiny[0], 0.09, 0.005);
  EXPECT_NEAR(tiny[1], 0.37, 0.01);
  EXPECT_THROW(MotionProfileNamed("gpu"), std::invalid_argument);
}

TEST(MotionModel, AblationsLeaveOutWhatTheyName) {
  for (const int left_out : {0, 1, 2, 3, 4}) {
    MotionConfig config = Toy();
    config.shape = left_out != 1;
    config.normals = left_out != 2;
    config.motion = left_out != 3;
    config.texture = left_out != 4;
    MotionModel model(config);
    EXPECT_EQ(model->texture.is_empty(), left_out == 4);
    EXPECT_EQ(model->encoder.is_empty(), left_out == 3);
    EXPECT_EQ(model->shape_decoder.is_empty(), left_out == 1);
    std::vector<MotionFrame> frames(2);
    ToyFrame(0, true, &frames[0]);
    ToyFrame(1, true, &frames[1]);
    const MotionInput input = InputOf(frames, config);
    EXPECT_EQ(input.motion.defined(), left_out != 3);
    const MotionStepResult result = model(input, model->Nothing(2, 32, 32));
    EXPECT_EQ(result.state.image.sizes(), (std::vector<int64_t>{2, 3, 32, 32}));
    EXPECT_EQ(result.state.labels.defined(), left_out != 1);
    EXPECT_EQ(result.state.normals.defined(), left_out != 2);
    EXPECT_GE(result.state.image.min().item<float>(), 0);
    EXPECT_LE(result.state.image.max().item<float>(), 1);
    if (left_out == 1) continue;
    EXPECT_NEAR((result.state.labels.sum(1) - 1).abs().max().item<float>(), 0, 1e-5);
    // Where the background is certain there is nothing to see.
    EXPECT_TRUE(torch::allclose(result.foreground, 1 - result.state.labels.slice(1, 0, 1)));
    EXPECT_TRUE((result.state.image <= result.foreground + 1e-6).all().item<bool>());
  }
}

/// Where the decoders add nothing, classes and colour are those of the texel that a pixel shows.
TEST(MotionModel, ATexelShowsItsLearnedClassAndColour) {
  const torch::NoGradGuard no_grad;
  torch::manual_seed(4);
  MotionModel model(Toy());
  for (Tensor& parameter : model->shape_decoder->parameters()) parameter.zero_();
  for (Tensor& parameter : model->appearance_decoder->parameters()) parameter.zero_();
  model->texture->values.uniform_(-0.1, 0.1);
  MotionFrame frame;
  ToyFrame(0, false, &frame);
  // Each pixel of the body shows the centre of one texel: (x, y) modulo 16, rows from the top at v = 1.
  for (int i = 0; i < 32 * 32; ++i) {
    frame.uv[i] = (static_cast<float>(i % 32 % 16) + 0.5F) / 16;
    frame.uv[32 * 32 + i] = 1 - (static_cast<float>(i / 32 % 16) + 0.5F) / 16;
  }
  const MotionStepResult result =
      model(InputOf(std::vector<MotionFrame>{frame}, model->config), model->Nothing(1, 32, 32));
  const Tensor labels = model->texture->labels_of_texel->weight.flatten(1);
  const Tensor colour = model->texture->colour_of_texel->weight.flatten(1);
  for (const auto& [x, y] :
       {std::pair(7, 9), std::pair(20, 15), std::pair(12, 23), std::pair(2, 2), std::pair(30, 12)}) {
    const bool body = frame.body[y * 32 + x] != 0;
    const Tensor texel = body ? 10 * model->texture->values[0].slice(1, y % 16, y % 16 + 1).slice(2, x % 16, x % 16 + 1)
                              : torch::zeros({4, 1, 1});
    const Tensor logits = labels.matmul(texel.flatten()), classes = torch::softmax(logits, 0);
    const Tensor seen = (1 - classes[0]) * torch::sigmoid(colour.matmul(texel.flatten()));
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(result.label_logits[0][k][y][x].item<float>(), logits[k].item<float>(), 1e-5) << x << ", " << y;
      EXPECT_NEAR(result.state.image[0][k][y][x].item<float>(), seen[k].item<float>(), 1e-5) << x << ", " << y;
    }
  }
}

TEST(MotionModel, ShiftedPicturesComeFromWhereTheyWere) {
  const Tensor image = torch::arange(2 * 1 * 4 * 5, torch::kFloat).reshape({2, 1, 4, 5});
  const Tensor moved = Shifted(image, 2, -1);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) {
      const bool inside = x - 2 >= 0 && y + 1 < 4;
      const float expected = inside ? image[1][0][y + 1][x - 2].item<float>() : 0.0F;
      EXPECT_EQ(moved[1][0][y][x].item<float>(), expected);
    }
  }
  EXPECT_TRUE(torch::equal(Shifted(image, 0, 0), image));
  EXPECT_EQ(Shifted(image, 5, 0).abs().max().item<float>(), 0);
}

/// The toy's frame described in the picture's plane: the shade is told beside the person, not on it.
void DenseToyFrame(int t, bool with_truth, MotionFrame* frame) {
  ToyFrame(t, with_truth, frame);
  const float level = frame->motion[0];
  frame->motion.clear();
  frame->dense.assign(2 * 32 * 32, 0);
  for (int i = 0; i < 32 * 32; ++i) frame->dense[32 * 32 + i] = frame->body[i] == 0 ? level : 0;
}

MotionConfig DenseToy() {
  MotionConfig config = Toy();
  config.descriptor = MotionDescriptor::kDense2d;
  config.motion_channels = 2;
  return config;
}

TEST(MotionModel, FeaturesOfThePicturesPlaneGoStraightToTheDecoders) {
  torch::manual_seed(8);
  MotionModel model(DenseToy());
  model->eval();
  const torch::NoGradGuard no_grad;
  std::vector<MotionFrame> frames(1);
  DenseToyFrame(3, false, &frames[0]);
  const MotionInput input = InputOf(frames, model->config);
  ASSERT_EQ(input.motion.sizes(), (std::vector<int64_t>{1, 2, 32, 32}));
  const Tensor features = model->Encode(input.motion), projected = model->Project(features, input.uv, input.body);
  EXPECT_TRUE(torch::equal(projected.slice(1, 0, 4), features)) << "on the body and off it";
  frames[0].dense.clear();
  EXPECT_THROW(InputOf(frames, model->config), std::invalid_argument);
  MotionConfig deep = DenseToy();
  deep.profile.encoder_widths.assign(3, 4);
  std::string why;
  EXPECT_FALSE(deep.IsValid(&why));
  EXPECT_NE(ToText(DenseToy()), ToText(Toy()));
  EXPECT_EQ(MotionDescriptorNamed("dense2d"), MotionDescriptor::kDense2d);
  EXPECT_THROW(MotionDescriptorNamed("keypoints"), std::invalid_argument);
}

TEST(MotionTraining, LearnsFromWhatThePicturesPlaneSays) {
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
                          {.warmup_iterations = 10, .reach = 2, .anywhere = true, .score = true, .num_threads = 1});
  for (int t = 0; t < 4; ++t) {
    MotionFrame frame;
    DenseToyFrame(t, true, &frame);
    renderer.Next(frame);
  }
  EXPECT_NEAR(renderer.scores().image_l1, summary.scores.image_l1, 1e-6);
}

/// Whole architectures, as `bodyloom neural card` prints them: a change of a shape anywhere is a change of these files.
TEST(MotionModel, IsWhatItsCardsSay) {
  for (const char* profile : {"tiny", "cpu", "paper"}) {
    MotionConfig config;
    config.profile = MotionProfileNamed(profile);
    EXPECT_EQ(MotionCard(config), FileBytes(SourceDir() + "/tests/neural/cards/motion_" + profile + ".txt"));
  }
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
  parts.progress = [](const TrainMotionProgress& progress) { return progress.step < 4; };
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
  const MotionPicture picture = renderer.Next(frame);
  double alpha = 0, red = 0;
  for (int y = 18; y < 22; ++y) {
    for (int x = 10; x < 18; ++x) alpha += picture.alpha[y * 32 + x] / 32, red += picture.image[y * 32 + x] / 32;
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

TEST(RollOut, KeepsWhatDoesNotChangeAndSaysTheSame) {
  torch::manual_seed(5);
  const MotionConfig config = Toy();
  MotionModel model(config);
  RollOut roll(model, 3);
  MotionState past = model->Nothing(1, 32, 32);
  const torch::NoGradGuard no_grad;
  for (const int t : {2, 2, 2, 3, 4, 4}) {
    MotionFrame frame;
    ToyFrame(t, false, &frame);
    frame.before_x = 0;
    const MotionStepResult kept = roll.Next(frame);
    const MotionInput input = InputOf(std::span(&frame, 1), config);
    const int passes = past.image.abs().max().item<float>() == 0 ? 4 : 1;
    for (int i = 0; i < passes; ++i) past = model(input, past).state;
    EXPECT_TRUE(torch::equal(kept.state.image, past.image)) << "frame " << t;
  }
  EXPECT_EQ(roll.descriptors_kept(), 3);
  EXPECT_EQ(roll.projections_kept(), 3);
}

TEST(RollOut, NothingIsBeyondReach) {
  torch::manual_seed(6);
  const MotionConfig config = Toy();
  MotionModel model(config);  // untrained: sees the person everywhere
  RollOut anywhere(model, 2), near(model, 2, {3});
  MotionFrame frame;
  ToyFrame(1, false, &frame);
  const MotionStepResult all = anywhere.Next(frame), kept = near.Next(frame);
  int beyond = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      // The body is [7, 23) × [8, 24).
      if (x >= 4 && x < 26 && y >= 5 && y < 27) continue;
      beyond += all.foreground[0][0][y][x].item<float>() > 0.01F;
      EXPECT_EQ(kept.foreground[0][0][y][x].item<float>(), 0);
      EXPECT_EQ(kept.state.labels[0][0][y][x].item<float>(), 1);
      EXPECT_EQ(kept.state.image[0][1][y][x].item<float>(), 0);
    }
  }
  EXPECT_GT(beyond, 100);
  EXPECT_GT(kept.foreground[0][0][5][4].item<float>(), 0);
}

TEST(ClothesReach, IsTheLongerOfBothDistances) {
  MotionFrame frame;
  ToyFrame(0, true, &frame);
  EXPECT_EQ(ClothesReach(std::span(&frame, 1)), 0);  // labels are where the body is: [6, 22) × [8, 24)
  frame.labels[10 * 32 + 27] = 1;                    // 6 to the right
  EXPECT_EQ(ClothesReach(std::span(&frame, 1), 0), 6);
  frame.labels[31 * 32 + 24] = 1;  // 3 to the right, 8 below
  EXPECT_EQ(ClothesReach(std::span(&frame, 1), 0), 8);
  EXPECT_EQ(ClothesReach(std::span(&frame, 1), 0.1), 0);  // two of 258 pixels may stay out
  frame.labels.clear();
  EXPECT_EQ(ClothesReach(std::span(&frame, 1)), 0);
}

TEST(MotionScores, AreZeroForTheTruthAndWhatTheyShouldBeBesideIt) {
  const MotionConfig config = Toy();
  MotionScorer perfect(config), shifted(config);
  for (int t = 0; t < 3; ++t) {
    MotionFrame frame;
    ToyFrame(t, true, &frame);
    const MotionTruth truth = TruthOf(std::span(&frame, 1), config);
    MotionState state = truth.State(config);
    perfect.Add(state, truth, 0, 0);
    // Off by 0.1, 0.2, 0.3: the error of every frame, and by how much it changes.
    state.image = truth.image + 0.1 * (t + 1);
    state.labels = truth.labels.clone();
    state.labels.slice(1, 1, 2).fill_(2);  // everything is of class 1
    shifted.Add(state, truth, 0, 0);
  }
  EXPECT_EQ(perfect.Scores().image_l1, 0);
  EXPECT_EQ(perfect.Scores().label_iou, 1);
  EXPECT_EQ(perfect.Scores().foreground_iou, 1);
  EXPECT_NEAR(perfect.Scores().normal_deg, 0, 0.05);
  const MotionScores scores = shifted.Scores();
  EXPECT_NEAR(scores.image_l1, 0.2, 1e-6);
  EXPECT_NEAR(scores.flicker, 0.1, 1e-6);
  EXPECT_NEAR(scores.psnr_db, -10 * std::log10((0.01 + 0.04 + 0.09) / 3), 1e-4);
  EXPECT_NEAR(scores.class_iou[1], 128.0 / 1024, 1e-6);
  EXPECT_EQ(scores.class_iou[2], 0);
  EXPECT_NEAR(scores.foreground_iou, 256.0 / 1024, 1e-6);
  EXPECT_NEAR(scores.label_iou, 0.5 * 128 / 1024, 1e-6);
}

/// A still picture in a window that jumps, and one that is off by a constant: what the whole window's scores are of.
TEST(MotionScores, WholeWindowsAreComparedWhereTheyWere) {
  const MotionConfig config = Toy();
  const auto lpips = std::make_shared<const Lpips>(LpipsOptions{LpipsTrunk::kAlexNet, 16, 1});
  const auto share_of_equal_bytes = [](const Image& truth, const Image& result) {
    int equal = 0;
    for (size_t i = 0; i < truth.bgr.size(); ++i) equal += truth.bgr[i] == result.bgr[i];
    return static_cast<double>(equal) / static_cast<double>(truth.bgr.size());
  };
  MotionScorer still(config, {lpips, share_of_equal_bytes});
  for (int t = 0; t < 4; ++t) {  // the square moves right by one a frame: so does what it is seen through
    MotionFrame frame;
    ToyFrame(t, true, &frame);
    for (int y = 0; y < 32; ++y) {  // a pattern that is the square's own
      for (int x = 0; x < 32; ++x) {
        for (int c = 0; c < 3; ++c) {
          frame.image[c * 1024 + y * 32 + x] =
              frame.body[y * 32 + x] * static_cast<float>((5 * (x - t) + 3 * y + c) % 11) / 11;
        }
      }
    }
    const MotionTruth truth = TruthOf(std::span(&frame, 1), config);
    MotionState state = truth.State(config);
    state.image = 0.5 * truth.image;
    still.Add(state, truth, t > 0 ? 1 : 0, 0);
    EXPECT_GT(still.last().lpips, 0);
    EXPECT_GT(still.last().ssim, 0.5) << "the background is equal";
    EXPECT_LT(still.last().ssim, 1);
    EXPECT_EQ(std::isnan(still.last().tlpips), t == 0);
    EXPECT_NEAR(t > 0 ? still.last().tlpips : 0, 0, 1e-12);
  }
  const MotionScores scores = still.Scores();
  EXPECT_NEAR(scores.tlpips, 0, 1e-12);
  EXPECT_NEAR(scores.flicker, 0, 1e-6) << "aligned alike";
  EXPECT_NEAR(scores.ssim, still.last().ssim, 1e-3);
  EXPECT_TRUE(scores.lpips_random_features);
  // Not requested, not measured.
  EXPECT_TRUE(std::isnan(MotionScorer(config).Scores().ssim));
  EXPECT_TRUE(std::isnan(MotionScorer(config).Scores().lpips));
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
  MotionPicture pictures[2];
  for (const char* device : {"cpu", "cuda"}) {
    MotionRenderer renderer(CheckpointPath(other.run_dir), other.config,
                            {.warmup_iterations = 0, .reach = 3, .num_threads = 1, .device = device});
    pictures[device[1] == 'u'] = renderer.Next(frame);
  }
  EXPECT_THAT(pictures[1].image, ::testing::Pointwise(::testing::FloatNear(1e-3F), pictures[0].image));
  UseNeuralDevice("cpu");
}

}  // namespace
}  // namespace bodyloom
