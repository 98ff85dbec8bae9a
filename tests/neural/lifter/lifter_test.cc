// SPDX-License-Identifier: Apache-2.0
// The lifter's network, loss and training. LibTorch is the reference for the tracker's own network code.
#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "neural/lifter/lifter_module.h"
#include "neural/lifter/train_lifter.h"
#include "tracking/lifter/lifter_network.h"

namespace bodyloom::lifter_test {
namespace {

namespace fs = std::filesystem;

LifterModule RandomModule(int inputs, int width, const std::vector<int>& dilations) {
  torch::manual_seed(3);
  LifterModule module(inputs, width, dilations);
  const torch::NoGradGuard no_grad;
  for (torch::Tensor& p : module->parameters()) p.add_(0.3 * torch::randn_like(p));
  return module;
}

TEST(LifterNetwork, MatrixProductsEqualLibTorch) {
  LifterModule module = RandomModule(11, 24, {1, 2, 4, 8});
  const LifterWeights weights = ExportLifter(module);
  std::string why;
  ASSERT_TRUE(weights.IsValid(&why)) << why;
  for (const int frames : {1, 2, 7, 96, 97, 250}) {
    const torch::Tensor x = torch::randn({1, 11, frames});
    const torch::Tensor y = module(x).transpose(1, 2).contiguous();
    const torch::Tensor rows = x.transpose(1, 2).contiguous();
    const RowMatrixXf ours = RunLifter(weights, Eigen::Map<const RowMatrixXf>(rows.data_ptr<float>(), frames, 11));
    const Eigen::Map<const RowMatrixXf> expected(y.data_ptr<float>(), frames, LifterOutput::kSize);
    ASSERT_EQ(ours.rows(), frames);
    EXPECT_LT((ours - expected).cwiseAbs().maxCoeff(), 2e-4 * (1 + expected.cwiseAbs().maxCoeff())) << frames;
  }
}

TEST(LifterNetwork, WeightsSurviveExportAndImport) {
  LifterModule from = RandomModule(5, 8, {1, 3}), to(5, 8, std::vector<int>{1, 3});
  ImportLifter(ExportLifter(from), &to);
  const torch::Tensor x = torch::randn({2, 5, 20});
  EXPECT_TRUE(torch::equal(from(x), to(x)));
  LifterModule other(5, 9, std::vector<int>{1, 3});
  EXPECT_THROW(ImportLifter(ExportLifter(from), &other), std::invalid_argument);
}

TEST(LifterNetwork, OutputIsPartitioned) {
  std::vector<int> owner(LifterOutput::kSize, 0);
  for (size_t i = 0; i < LifterOutput::kTorso.size(); ++i) {
    for (int c = 0; c < 5; ++c) ++owner[LifterOutput::TorsoOffset(static_cast<int>(i)) + c];
  }
  std::vector<int> points(LifterOutput::kPoints, 0);
  for (const int k : LifterOutput::kTorso) ++points[k];
  for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {
    for (int m = 0; m < LifterOutput::kHypotheses; ++m) ++owner[LifterOutput::LogitOffset(limb) + m];
    const auto indices = LifterOutput::LimbPoints(limb);
    for (const int k : indices) ++points[k];
    for (int m = 0; m < LifterOutput::kHypotheses; ++m) {
      for (size_t i = 0; i < indices.size(); ++i) {
        for (int c = 0; c < 5; ++c) ++owner[LifterOutput::PointOffset(limb, m, static_cast<int>(i)) + c];
      }
    }
  }
  for (int c = 0; c < 4; ++c) ++owner[LifterOutput::kUp + c];
  for (int c = 0; c < 2; ++c) ++owner[LifterOutput::kContact + c];
  EXPECT_EQ(owner, std::vector<int>(LifterOutput::kSize, 1));
  EXPECT_EQ(points, std::vector<int>(LifterOutput::kPoints, 1));
}

/// The loss spelled out with loops, for one window.
double SlowLoss(const torch::Tensor& output, const LifterTargets& targets, const LifterLossOptions& options) {
  const int64_t T = output.size(2);
  const auto y = output[0].transpose(0, 1).contiguous().to(torch::kDouble);
  const double* out = y.data_ptr<double>();
  const auto truth_tensor = targets.points[0].contiguous().to(torch::kDouble);
  const double* truth = truth_tensor.data_ptr<double>();
  const auto nll_of = [&](const double* p, const double* t) {
    const double lxy = std::clamp(p[3], -5.0, 1.0), lz = std::clamp(p[4], -5.0, 1.0);
    const double xy2 = std::pow(p[0] - t[0], 2) + std::pow(p[1] - t[1], 2), z2 = std::pow(p[2] - t[2], 2);
    return std::sqrt(xy2 * std::exp(-2 * lxy) + z2 * std::exp(-2 * lz) + 1e-6) + 2 * lxy + lz;
  };
  const auto distance_of = [&](const double* p, const double* t) {
    return std::sqrt(std::pow(p[0] - t[0], 2) + std::pow(p[1] - t[1], 2) + std::pow(p[2] - t[2], 2) + 1e-6);
  };
  double distance = 0, nll = 0, weight = 0, velocity = 0, up = 0, contact = 0;
  std::vector<std::array<std::array<double, 3>, 21>> predicted(T);
  for (int64_t t = 0; t < T; ++t) {
    const double* f = out + t * LifterOutput::kSize;
    const double* g = truth + t * 63;
    weight = 0;
    for (int i = 0; i < 9; ++i) {
      const int k = LifterOutput::kTorso[i];
      const double w = k < 5 ? 0.5 : 1;
      weight += w;
      distance += w * distance_of(f + 5 * i, g + 3 * k);
      nll += w * nll_of(f + 5 * i, g + 3 * k);
      for (int c = 0; c < 3; ++c) predicted[t][k][c] = f[5 * i + c];
    }
    for (int limb = 0; limb < 4; ++limb) {
      const auto points = LifterOutput::LimbPoints(limb);
      double logits = 0, joint[3], sum = 0;
      for (int m = 0; m < 3; ++m) logits += std::exp(f[LifterOutput::LogitOffset(limb) + m]);
      double d[3] = {0, 0, 0};
      for (int m = 0; m < 3; ++m) {
        joint[m] = f[LifterOutput::LogitOffset(limb) + m] - std::log(logits);
        for (size_t i = 0; i < points.size(); ++i) {
          const double* p = f + LifterOutput::PointOffset(limb, m, static_cast<int>(i));
          joint[m] -= nll_of(p, g + 3 * points[i]);
          d[m] += distance_of(p, g + 3 * points[i]);
        }
        sum += std::exp(joint[m]);
      }
      nll -= 1.5 * std::log(sum);
      weight += 1.5 * static_cast<double>(points.size());
      for (size_t i = 0; i < points.size(); ++i) predicted[t][points[i]] = {0, 0, 0};
      for (int m = 0; m < 3; ++m) {
        const double q = std::exp(joint[m]) / sum;
        distance += 1.5 * q * d[m];
        for (size_t i = 0; i < points.size(); ++i) {
          for (int c = 0; c < 3; ++c) {
            predicted[t][points[i]][c] += q * f[LifterOutput::PointOffset(limb, m, static_cast<int>(i)) + c];
          }
        }
      }
    }
    double off = 1e-6;
    for (int c = 0; c < 3; ++c) off += std::pow(f[LifterOutput::kUp + c] - targets.up[0][t][c].item<double>(), 2);
    const double ls = std::clamp(f[LifterOutput::kUp + 3], -5.0, 1.0);
    up += std::sqrt(off) * std::exp(-ls) + ls;
    for (int c = 0; c < 2; ++c) {
      const double p = 1 / (1 + std::exp(-f[LifterOutput::kContact + c])), z = targets.contact[0][t][c].item<double>();
      contact -= z * std::log(p) + (1 - z) * std::log(1 - p);
    }
  }
  for (int64_t t = 1; t < T; ++t) {
    for (int k = 0; k < 21; ++k) {
      double squared = 1e-6;
      for (int c = 0; c < 3; ++c) {
        const double step = truth[t * 63 + 3 * k + c] - truth[(t - 1) * 63 + 3 * k + c];
        squared += std::pow(predicted[t][k][c] - predicted[t - 1][k][c] - step, 2);
      }
      velocity += std::sqrt(squared);
    }
  }
  const double n = static_cast<double>(T);
  return distance / weight / n + options.nll_weight * nll / weight / n +
         options.velocity_weight * velocity / (21 * (n - 1)) + 0.1 * up / n + 0.05 * contact / (2 * n);
}

LifterTargets RandomTargets(int batch, int frames) {
  LifterTargets targets;
  targets.points = 0.4 * torch::randn({batch, frames, 21, 3});
  targets.up = torch::nn::functional::normalize(torch::randn({batch, frames, 3}),
                                                torch::nn::functional::NormalizeFuncOptions().dim(2));
  targets.contact = torch::rand({batch, frames, 2}).round();
  return targets;
}

TEST(LifterLoss, EqualsItsDefinition) {
  torch::manual_seed(5);
  const LifterTargets targets = RandomTargets(1, 6);
  const torch::Tensor output = 0.5 * torch::randn({1, LifterOutput::kSize, 6});
  const LifterLossOptions options;
  EXPECT_NEAR(ComputeLifterLoss(output, targets, options).total.item<double>(), SlowLoss(output, targets, options),
              2e-5);
}

TEST(LifterLoss, TruthIsCheapestAndChoosesWell) {
  torch::manual_seed(6);
  const LifterTargets targets = RandomTargets(2, 5);
  torch::Tensor output = torch::zeros({2, LifterOutput::kSize, 5});
  const auto put = [&](int offset, int k) {
    for (int c = 0; c < 3; ++c) {
      output.select(1, offset + c).copy_(targets.points.select(2, k).select(2, c));
    }
  };
  for (int i = 0; i < 9; ++i) put(LifterOutput::TorsoOffset(i), LifterOutput::kTorso[i]);
  for (int limb = 0; limb < 4; ++limb) {  // the second hypothesis is right; the first is the likeliest
    for (size_t i = 0; i < LifterOutput::LimbPoints(limb).size(); ++i) {
      put(LifterOutput::PointOffset(limb, 1, static_cast<int>(i)), LifterOutput::LimbPoints(limb)[i]);
    }
    output.select(1, LifterOutput::LogitOffset(limb)).fill_(1);
  }
  EXPECT_LT((NearestPoints(output, targets.points) - targets.points).abs().max().item<double>(), 1e-6);
  const torch::Tensor likeliest = LikeliestPoints(output);
  EXPECT_LT((likeliest.select(2, 5) - targets.points.select(2, 5)).abs().max().item<double>(), 1e-6);
  EXPECT_LT(likeliest.select(2, 9).abs().max().item<double>(), 1e-6) << "the first hypothesis is at the origin";
}

/// A toy world: the landmarks are a linear function of the features.
void ToyExample(uint64_t seed, int frames, int inputs, LifterExample* example) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal;
  example->features.resize(size_t(frames) * inputs);
  example->points.resize(size_t(frames) * 63);
  example->up.assign(size_t(frames) * 3, 0);
  example->contact.assign(size_t(frames) * 2, 0);
  for (float& x : example->features) x = normal(random);
  for (int t = 0; t < frames; ++t) {
    for (int i = 0; i < 63; ++i) {
      example->points[size_t(t) * 63 + i] = 0.3F * example->features[size_t(t) * inputs + i % inputs];
    }
    example->up[size_t(t) * 3 + 1] = -1;
    example->contact[size_t(t) * 2] = example->features[size_t(t) * inputs] > 0 ? 1.0F : 0.0F;
  }
}

class LifterTraining : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("lifter_training_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    options_.num_inputs = 7;
    options_.num_frames = 12;
    options_.width = 16;
    options_.dilations = {1, 2};
    options_.steps = 40;
    options_.batch = 4;
    options_.warmup_steps = 5;
    options_.report_every = 5;
    options_.validate_every = 20;
    options_.checkpoint_every = 10;
    options_.validation_windows = 8;
    options_.num_threads = 1;  // operations this small are slower on two
    options_.run_dir = folder_.string();
  }
  static LifterSource Source() {
    return [](uint64_t seed, LifterExample* example) { ToyExample(seed, 12, 7, example); };
  }
  static bool SameBytes(const LifterWeights& a, const LifterWeights& b) {
    bool same = a.input == b.input && a.input_bias == b.input_bias && a.output == b.output &&
                a.output_bias == b.output_bias && a.norm_scale == b.norm_scale && a.blocks.size() == b.blocks.size();
    for (size_t i = 0; same && i < a.blocks.size(); ++i) {
      same = a.blocks[i].dilated == b.blocks[i].dilated && a.blocks[i].mix == b.blocks[i].mix &&
             a.blocks[i].norm_scale == b.blocks[i].norm_scale;
    }
    return same;
  }
  static int NumLines(const fs::path& path) {
    std::ifstream file(path);
    int lines = 0;
    for (std::string line; std::getline(file, line);) ++lines;
    return lines;
  }
  fs::path folder_;
  TrainLifterOptions options_;
};

TEST_F(LifterTraining, LearnsTheToyWorld) {
  options_.steps = 400;
  options_.learning_rate = 5e-3;
  options_.average = 0.9;
  options_.validate_every = 400;
  const TrainLifterResult result = TrainLifter(Source(), Source(), options_);
  EXPECT_EQ(result.summary.status, TrainingStatus::kFinished);
  // Saying nothing is off by the mean length of the landmarks, 0.3 · √(8/π) = 0.48.
  EXPECT_LT(result.summary.validation_distance, 0.12);
  EXPECT_LE(result.summary.validation_best_distance, result.summary.validation_distance + 1e-6);
}

TEST_F(LifterTraining, AnInterruptedRunEndsWithTheSameBytes) {
  const TrainLifterResult whole = TrainLifter(Source(), Source(), options_);
  const std::string whole_metrics = (folder_ / "metrics.csv").string();
  EXPECT_EQ(NumLines(whole_metrics), 1 + 8);
  fs::remove_all(folder_);
  fs::create_directories(folder_);
  options_.progress = [](const TrainingProgress& progress) { return progress.step < 25; };
  const TrainLifterResult part = TrainLifter(Source(), Source(), options_);
  EXPECT_EQ(part.summary.status, TrainingStatus::kStopped);
  EXPECT_EQ(part.summary.steps, 25);
  EXPECT_FALSE(SameBytes(part.weights, whole.weights));
  options_.progress = nullptr;
  options_.resume = true;
  const TrainLifterResult rest = TrainLifter(Source(), Source(), options_);
  EXPECT_EQ(rest.summary.status, TrainingStatus::kFinished);
  EXPECT_TRUE(SameBytes(rest.weights, whole.weights));
  EXPECT_EQ(NumLines(folder_ / "metrics.csv"), 1 + 8);
}

TEST_F(LifterTraining, BeginsWithGivenWeights) {
  options_.steps = 200;
  options_.learning_rate = 5e-3;
  options_.average = 0.9;
  const TrainLifterResult learned = TrainLifter(Source(), Source(), options_);
  fs::remove_all(folder_);
  fs::create_directories(folder_);
  options_.steps = 20;
  options_.learning_rate = 1e-4;
  options_.begin_with = &learned.weights;
  const TrainLifterResult more = TrainLifter(Source(), Source(), options_);
  EXPECT_NEAR(more.summary.validation_distance, learned.summary.validation_distance, 0.02);
  LifterWeights other = learned.weights;
  other.blocks.pop_back();
  options_.begin_with = &other;
  EXPECT_THROW(TrainLifter(Source(), Source(), options_), std::invalid_argument);
}

TEST_F(LifterTraining, ALossThatIsNotFiniteKeepsTheCheckpoint) {
  const LifterSource poisoned = [](uint64_t seed, LifterExample* example) {
    ToyExample(seed, 12, 7, example);
    if (seed % (uint64_t{1} << 40) >= 4 * 23) example->points[5] = std::numeric_limits<float>::quiet_NaN();
  };
  const TrainLifterResult result = TrainLifter(poisoned, Source(), options_);
  EXPECT_EQ(result.summary.status, TrainingStatus::kNotFinite);
  EXPECT_NE(result.summary.message.find("step 24"), std::string::npos) << result.summary.message;
  EXPECT_NE(result.summary.message.find("holds step 20"), std::string::npos) << result.summary.message;
  EXPECT_TRUE(fs::exists(folder_ / "checkpoint.bin"));
}

TEST_F(LifterTraining, RefusesCheckpointsThatAreNotOurs) {
  options_.resume = true;
  EXPECT_THROW(TrainLifter(Source(), Source(), options_), std::runtime_error);
  std::ofstream(folder_ / "checkpoint.bin") << "not a checkpoint";
  try {
    TrainLifter(Source(), Source(), options_);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("checkpoint.bin"), std::string::npos) << error.what();
  }
  options_.resume = false;
  options_.steps = 10;
  TrainLifter(Source(), Source(), options_);
  options_.resume = true;
  options_.width = 24;
  EXPECT_THROW(TrainLifter(Source(), Source(), options_), std::runtime_error) << "another network's checkpoint";
}

TEST_F(LifterTraining, ExamplesOfTheWrongSizeAreRefused) {
  const LifterSource wrong = [](uint64_t seed, LifterExample* example) { ToyExample(seed, 11, 7, example); };
  EXPECT_THROW(TrainLifter(wrong, Source(), options_), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::lifter_test
