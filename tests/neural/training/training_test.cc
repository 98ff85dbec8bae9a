// SPDX-License-Identifier: Apache-2.0
// Schedules, the metrics log, and checkpoints: a resumed run ends bit-identical to an uninterrupted one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/torch.h>
#include <unistd.h>
#include <stdexcept>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "neural/networks/unet.h"
#include "neural/training/checkpoint.h"
#include "neural/training/optimizers.h"
#include "neural/training/run_files.h"
#include "tests/support/test_files.h"

namespace bodyloom::training_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using torch::Tensor;

/// A folder of its own, removed at the end.
class TrainingFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("bodyloom_" + std::string(info->name()) + "_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  fs::path folder_;
};

using Checkpoints = TrainingFiles;
using MetricsLogs = TrainingFiles;

void WriteBytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

std::string ErrorOf(const std::function<void()>& function) {
  try {
    function();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Schedules, LinearDecayOverTheLastHalf) {
  EXPECT_EQ(LinearDecayOverLastHalf(0.2, 0, 100), 0.2);
  EXPECT_EQ(LinearDecayOverLastHalf(0.2, 50, 100), 0.2);
  EXPECT_NEAR(LinearDecayOverLastHalf(0.2, 75, 100), 0.1, 1e-15);
  EXPECT_NEAR(LinearDecayOverLastHalf(0.2, 99, 100), 0.004, 1e-15);
  EXPECT_EQ(LinearDecayOverLastHalf(0.2, 100, 100), 0);
  EXPECT_EQ(LinearDecayOverLastHalf(0.2, 130, 100), 0);
  EXPECT_THROW(LinearDecayOverLastHalf(0.2, -1, 100), std::invalid_argument);
}

TEST(Schedules, CosineWithWarmup) {
  EXPECT_NEAR(CosineWithWarmup(1, 0, 100, 10), 0.1, 1e-15);
  EXPECT_NEAR(CosineWithWarmup(1, 4, 100, 10), 0.5 * 0.5 * (1 + std::cos(0.04 * M_PI)), 1e-15);
  EXPECT_NEAR(CosineWithWarmup(1, 50, 100, 10), 0.5, 1e-15);
  EXPECT_NEAR(CosineWithWarmup(1, 0, 100, 0), 1, 1e-15);
  EXPECT_NEAR(CosineWithWarmup(1, 200, 100, 10), 0, 1e-15);
  EXPECT_THROW(CosineWithWarmup(1, 0, 0, 10), std::invalid_argument);
}

TEST_F(MetricsLogs, LaterLinesAreWrittenAnew) {
  MetricsLog log(Path("metrics.csv"), {"loss", "validation"});
  log.Add(10, {0.5, NAN});
  log.Add(20, {0.25, 3});
  log.Add(30, {0.125, NAN});
  EXPECT_EQ(FileBytes(Path("metrics.csv")), "step,loss,validation\n10,0.5,\n20,0.25,3\n30,0.125,\n");
  MetricsLog again(Path("metrics.csv"), {"loss", "validation"});
  again.KeepUpTo(20);
  again.Add(30, {7, 8});
  EXPECT_EQ(FileBytes(Path("metrics.csv")), "step,loss,validation\n10,0.5,\n20,0.25,3\n30,7,8\n");
  EXPECT_THROW(again.Add(40, {1}), std::invalid_argument);
  MetricsLog other(Path("metrics.csv"), {"loss"});
  EXPECT_EQ(ErrorOf([&] { other.KeepUpTo(20); }),
            Path("metrics.csv") + ": line 1: columns \"step,loss,validation\", expected \"step,loss\"");
  // A column that an earlier version did not write is empty in its lines.
  MetricsLog more(Path("metrics.csv"), {"loss", "added", "validation", "last"});
  more.KeepUpTo(20);
  EXPECT_EQ(more.text(), "step,loss,added,validation,last\n10,0.5,,,\n20,0.25,,3,\n");
  MetricsLog order(Path("metrics.csv"), {"validation", "loss"});
  EXPECT_THAT(ErrorOf([&] { order.KeepUpTo(20); }), ::testing::HasSubstr("expected \"step,validation,loss\""));
  MetricsLog none(Path("none.csv"), {"loss"});
  none.KeepUpTo(20);
  EXPECT_EQ(none.text(), "step,loss\n");
}

TEST_F(MetricsLogs, FilesAppearWholeOrNotAtAll) {
  WriteRunText(Path("a.txt"), "old");
  {
    RunFile file(Path("a.txt"));
    file.Write("new", 3);
    EXPECT_EQ(FileBytes(Path("a.txt")), "old");
  }
  EXPECT_EQ(FileBytes(Path("a.txt")), "old");
  EXPECT_FALSE(fs::exists(Path("a.txt.part")));
  EXPECT_THAT(ErrorOf([&] { WriteRunText(Path("none/a.txt"), "x"); }), StartsWith(Path("none/a.txt") + ": cannot be"));
  if (fs::exists("/dev/full")) {
    fs::create_symlink("/dev/full", Path("b.txt.part"));
    EXPECT_THAT(ErrorOf([&] { WriteRunText(Path("b.txt"), "x"); }), HasSubstr("No space left"));
    EXPECT_FALSE(fs::exists(Path("b.txt")));
  }
}

/// A small network with a batch norm (buffers), two optimizers and a recurrence, trained on random numbers.
struct ToyRun {
  explicit ToyRun(uint64_t seed, int width = 4) {
    torch::manual_seed(seed);
    net = UNet(UNetOptions{2, {1}, {width, width}});
    norm = torch::nn::BatchNorm2d(2);
    adam = std::make_unique<torch::optim::Adam>(net->parameters(),
                                                torch::optim::AdamOptions(1e-2).betas({0.5, 0.999}).amsgrad(true));
    adamw = std::make_unique<torch::optim::AdamW>(norm->parameters(), torch::optim::AdamWOptions(1e-3));
    checkpoint.Add("net", net.get());
    checkpoint.Add("norm", norm.get());
    checkpoint.Add("adam", adam.get());
    checkpoint.Add("adamw", adamw.get());
    checkpoint.Add("last", &last);
    checkpoint.config_json = "{\"width\": 4}";
  }

  void Train(int steps) {
    for (int i = 0; i < steps; ++i) {
      for (auto& group : adam->param_groups()) {
        group.options().set_lr(LinearDecayOverLastHalf(1e-2, checkpoint.step, 10));
      }
      const Tensor x = torch::randn({1, 2, 8, 8});
      const Tensor input = last.defined() ? norm(x) + last : norm(x);
      const Tensor y = net(input)[0];
      const Tensor loss = (y - x.sum(1, true)).square().mean();
      adam->zero_grad();
      adamw->zero_grad();
      loss.backward();
      adam->step();
      adamw->step();
      last = y.detach();
      losses.push_back(loss.item<float>());
      ++checkpoint.step;
    }
  }

  UNet net{nullptr};
  torch::nn::BatchNorm2d norm{nullptr};
  std::unique_ptr<torch::optim::Adam> adam;
  std::unique_ptr<torch::optim::AdamW> adamw;
  Tensor last;
  std::vector<float> losses;
  Checkpoint checkpoint{"toy run, profile tiny"};
};

TEST_F(Checkpoints, ARunGoesOnBitForBit) {
  ToyRun whole(1);
  whole.Train(10);
  whole.checkpoint.Save(Path("whole.bin"));

  ToyRun first(1);
  first.Train(5);
  first.checkpoint.Save(Path("half.bin"));
  ToyRun second(99);  // other weights, other random numbers, other moments
  second.Train(3);
  second.losses.clear();
  second.checkpoint.Load(Path("half.bin"));
  EXPECT_EQ(second.checkpoint.step, 5);
  EXPECT_EQ(second.checkpoint.config_json, "{\"width\": 4}");
  second.Train(5);
  second.checkpoint.Save(Path("resumed.bin"));

  EXPECT_EQ(FileBytes(Path("whole.bin")), FileBytes(Path("resumed.bin")));
  EXPECT_EQ(second.losses, std::vector<float>(whole.losses.begin() + 5, whole.losses.end()));
  EXPECT_NE(whole.losses[4], whole.losses[9]);
  EXPECT_FALSE(fs::exists(Path("half.bin.part")));
}

TEST_F(Checkpoints, BeforeTheFirstStepTheOptimizersAreEmpty) {
  ToyRun fresh(1), used(2);
  fresh.checkpoint.Save(Path("a.bin"));
  used.Train(2);
  used.checkpoint.Load(Path("a.bin"));
  EXPECT_TRUE(used.adam->state().empty());
  EXPECT_FALSE(used.last.defined());
  used.Train(2);
  fresh.checkpoint.Load(Path("a.bin"));
  fresh.Train(2);
  EXPECT_EQ(fresh.losses, std::vector<float>(used.losses.begin() + 2, used.losses.end()));
}

TEST_F(Checkpoints, ModulesAloneForInference) {
  ToyRun run(1);
  run.Train(2);
  run.checkpoint.Save(Path("a.bin"));
  const CheckpointInfo info = ReadCheckpointInfo(Path("a.bin"));
  EXPECT_EQ(info.identity, "toy run, profile tiny");
  EXPECT_EQ(info.config_json, "{\"width\": 4}");
  EXPECT_EQ(info.step, 2);
  UNet net(UNetOptions{2, {1}, {4, 4}});
  Checkpoint inference("toy run, profile tiny");
  inference.Add("net", net.get());
  torch::manual_seed(5);
  const Tensor expected = torch::rand({1});
  torch::manual_seed(5);
  inference.Load(Path("a.bin"), CheckpointPart::kModules);
  EXPECT_TRUE(torch::equal(torch::rand({1}), expected)) << "the random generator is not inference's to change";
  const Tensor x = torch::randn({1, 2, 8, 8});
  EXPECT_TRUE(torch::equal(net(x)[0], run.net(x)[0]));
  EXPECT_THAT(ErrorOf([&] { inference.Load(Path("a.bin")); }), HasSubstr("that the network does not have"));
}

/// The error of loading a file, and that trying changed nothing.
std::string LoadError(const std::string& path, int width = 4, const std::string& identity = "toy run, profile tiny") {
  ToyRun run(3, width);
  run.Train(1);
  Checkpoint checkpoint(identity);
  checkpoint.Add("net", run.net.get());
  checkpoint.Add("norm", run.norm.get());
  checkpoint.Add("adam", run.adam.get());
  checkpoint.Add("adamw", run.adamw.get());
  checkpoint.Add("last", &run.last);
  checkpoint.step = 7;
  const auto state = [&] {
    const auto& adam = static_cast<const torch::optim::AdamParamState&>(*run.adam->state().begin()->second);
    return torch::cat({torch::nn::utils::parameters_to_vector(run.net->parameters()).to(torch::kDouble),
                       adam.exp_avg().flatten().to(torch::kDouble), run.last.flatten().to(torch::kDouble),
                       at::detail::getDefaultCPUGenerator().get_state().to(torch::kDouble)});
  };
  const Tensor before = state().clone();
  std::string error = ErrorOf([&] { checkpoint.Load(path); });
  EXPECT_NE(error, "");
  EXPECT_TRUE(torch::equal(before, state()));
  EXPECT_EQ(checkpoint.step, 7);
  return error;
}

TEST_F(Checkpoints, OtherNetworksAreRefusedByName) {
  ToyRun run(1);
  run.Train(1);
  run.checkpoint.Save(Path("a.bin"));
  EXPECT_EQ(
      LoadError(Path("a.bin"), 5),
      Path("a.bin") +
          ": modules/net/encoder0.conv1.weight: Float of shape [4, 2, 3, 3], expected Float of shape [5, 2, 3, 3]");
  EXPECT_EQ(LoadError(Path("a.bin"), 4, "another"),
            Path("a.bin") + ": a checkpoint of \"toy run, profile tiny\", expected one of \"another\"");
}

// Whatever is cut off, added or flipped: one line that names the file, and nothing changes.
TEST_F(Checkpoints, DamagedFilesAreRefused) {
  Tensor values = torch::arange(6).view({2, 3}), none;
  Checkpoint small("small");
  small.Add("values", &values);
  small.Add("none", &none);
  small.Save(Path("good.bin"));
  const std::string good = FileBytes(Path("good.bin")), path = Path("bad.bin");
  const Tensor before = values;
  const auto error_of = [&](const std::string& bytes) {
    WriteBytes(path, bytes);
    std::string error = ErrorOf([&] { small.Load(path); });
    EXPECT_TRUE(values.is_same(before));
    EXPECT_EQ(error.find('\n'), std::string::npos);
    return error;
  };
  for (size_t size = 0; size < good.size(); size += size < 150 ? 1 : 97) {
    ASSERT_THAT(error_of(good.substr(0, size)), StartsWith(path + ": ")) << size;
  }
  EXPECT_THAT(error_of(good.substr(0, good.size() - 1)),
              HasSubstr("cut off or damaged: " + std::to_string(good.size() - 1) + " bytes, expected " +
                        std::to_string(good.size())));
  for (size_t at = 0; at < good.size(); at += at < 150 ? 1 : 89) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ (1 << (at % 8)));
    ASSERT_THAT(error_of(bad), StartsWith(path + ": ")) << at;
  }
  EXPECT_THAT(error_of(good + "x"), HasSubstr("damaged"));
  EXPECT_EQ(error_of("PK\x03\x04 some other file"), path + ": not a checkpoint of this program");
  EXPECT_EQ(error_of(""), path + ": not a checkpoint of this program");
  fs::remove(path);
  EXPECT_THAT(ErrorOf([&] { small.Load(path); }), StartsWith(path + ": cannot be opened"));
  EXPECT_EQ(ErrorOf([&] { small.Load(folder_.string()); }), folder_.string() + ": a folder, expected a checkpoint");
  small.Load(Path("good.bin"));
  EXPECT_TRUE(torch::equal(values, torch::arange(6).view({2, 3})));
}

TEST_F(Checkpoints, NamesAndOptimizersAreChecked) {
  Checkpoint checkpoint("x");
  Tensor tensor;
  checkpoint.Add("a", &tensor);
  EXPECT_THROW(checkpoint.Add("a", &tensor), std::invalid_argument);
  EXPECT_THROW(checkpoint.Add("", &tensor), std::invalid_argument);
  EXPECT_THROW(checkpoint.Add("a/b", &tensor), std::invalid_argument);
  torch::optim::SGD sgd({torch::zeros({1}, torch::requires_grad())}, 0.1);
  EXPECT_THROW(checkpoint.Add("sgd", &sgd), std::invalid_argument);
}

TEST(Muon, OrthogonalFactorsHaveSingularValuesNearOne) {
  torch::manual_seed(3);
  for (const auto& [m, n] : {std::pair<int, int>{24, 24}, {24, 72}, {72, 24}, {1, 8}}) {
    // Singular values from 1 down to 0.02.
    const int rank = std::min(m, n);
    Tensor u = std::get<0>(torch::linalg_qr(torch::randn({m, rank}, torch::kDouble)));
    Tensor v = std::get<0>(torch::linalg_qr(torch::randn({n, rank}, torch::kDouble)));
    const Tensor s = torch::logspace(0, -1.7, rank, 10, torch::kDouble);
    const Tensor matrix = torch::matmul(u * s, v.t());
    const Tensor result = ApproximateOrthogonalFactor(matrix);
    ASSERT_EQ(result.sizes(), matrix.sizes());
    const Tensor values = torch::linalg_svdvals(result);
    EXPECT_GT(values.min().item<double>(), 0.3) << m << "x" << n;
    EXPECT_LT(values.max().item<double>(), 1.3) << m << "x" << n;
    // The same singular vectors: Uᵀ X V is diagonal.
    const Tensor core = torch::matmul(torch::matmul(u.t(), result), v);
    EXPECT_LT((core - torch::diag(torch::diag(core))).abs().max().item<double>(), 1e-9) << m << "x" << n;
  }
  EXPECT_EQ(ApproximateOrthogonalFactor(torch::zeros({4, 6})).abs().max().item<float>(), 0);
}

TEST(Muon, StepsAsItsFormulaSays) {
  torch::manual_seed(4);
  Tensor weight = torch::randn({6, 4, 3}, torch::kDouble).requires_grad_(true);
  Muon muon({weight}, {.momentum = 0.9, .weight_decay = 0.1});
  Tensor expected = weight.detach().clone(), momentum = torch::zeros_like(expected);
  for (int step = 0; step < 3; ++step) {
    const Tensor gradient = torch::randn({6, 4, 3}, torch::kDouble);
    weight.mutable_grad() = gradient.clone();
    muon.Step(0.01);
    momentum = 0.9 * momentum + gradient;
    const Tensor turn = ApproximateOrthogonalFactor((gradient + 0.9 * momentum).reshape({6, 12})).reshape({6, 4, 3});
    expected = (1 - 0.01 * 0.1) * expected - 0.01 * 0.2 * std::sqrt(12.0) * turn;
    EXPECT_LT((weight.detach() - expected).abs().max().item<double>(), 1e-12) << step;
  }
}

TEST(Muon, GoesOnFromWhatItSaved) {
  torch::manual_seed(5);
  const Tensor start = torch::randn({4, 5});
  const auto step = [](Muon* muon, Tensor* weight, int seed) {
    torch::manual_seed(seed);
    weight->mutable_grad() = torch::randn({4, 5});
    muon->Step(0.02);
  };
  Tensor a = start.clone().requires_grad_(true), b = start.clone().requires_grad_(true);
  Muon whole({a}, {}), first({b}, {}), second({b}, {});
  step(&whole, &a, 1);
  step(&whole, &a, 2);
  step(&first, &b, 1);
  for (size_t i = 0; i < first.momenta().size(); ++i) second.momenta()[i] = first.momenta()[i].clone();
  step(&second, &b, 2);
  EXPECT_TRUE(torch::equal(a, b));
}

TEST(Muon, RefusesVectors) { EXPECT_THROW(Muon({torch::zeros({4})}, {}), std::invalid_argument); }

void SetAll(torch::nn::Module* module, double value) {
  const torch::NoGradGuard no_grad;
  for (torch::Tensor& parameter : module->parameters()) parameter.fill_(value);
}

double First(const torch::nn::Module& module) { return module.parameters()[0].flatten()[0].item<double>(); }

// Averages of weights against the sums that define them.

TEST(WeightAverage, IsTheSumWeightedByAPowerOfTheStep) {
  // A share of a quarter is γ = 2, for which the recurrence has the weights t (t + 1).
  torch::nn::Linear learner(2, 2), average(2, 2);
  learner->to(torch::kDouble);
  average->to(torch::kDouble);
  double sum = 0, weights = 0;
  for (int t = 1; t <= 400; ++t) {
    const double value = std::sin(0.3 * t) + 0.01 * t;
    sum += t * (t + 1.0) * value;
    weights += t * (t + 1.0);
    SetAll(learner.get(), value);
    AverageWeights(*learner, t, 0.25, average.get());
    ASSERT_NEAR(First(*average), sum / weights, 1e-12) << t;
  }
}

TEST(WeightAverage, IsAsOldAsItsShareSays) {
  for (const double share : {0.05, 0.1, 0.5}) {
    torch::nn::Linear learner(1, 1), average(1, 1);
    learner->to(torch::kDouble);
    average->to(torch::kDouble);
    constexpr int kSteps = 20000;
    for (int t = 1; t <= kSteps; ++t) {
      SetAll(learner.get(), t);
      AverageWeights(*learner, t, share, average.get());
    }
    EXPECT_NEAR((kSteps - First(*average)) / kSteps, share, 1e-3);
  }
}

TEST(WeightAverage, CopiesBuffers) {
  torch::nn::BatchNorm1d learner(3), average(3);
  learner->running_mean.fill_(7);
  AverageWeights(*learner, 5, 0.1, average.get());
  EXPECT_EQ(average->running_mean[0].item<float>(), 7);
}

TEST(WeightAverage, RefusesWhatDoesNotFit) {
  torch::nn::Linear learner(2, 2), same(2, 2), wider(2, 3);
  EXPECT_THROW(AverageWeights(*learner, 1, 0.1, wider.get()), std::invalid_argument);
  EXPECT_THROW(AverageWeights(*learner, 0, 0.1, same.get()), std::invalid_argument);
  EXPECT_THROW(AverageWeights(*learner, 1, 0, same.get()), std::invalid_argument);
  EXPECT_THROW(AverageWeights(*learner, 1, 0.6, same.get()), std::invalid_argument);
}

}  // namespace

}  // namespace bodyloom::training_test
