// SPDX-License-Identifier: Apache-2.0
// Schedules, the metrics log, and checkpoints: a resumed run ends bit-identical to an uninterrupted one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <torch/torch.h>
#include <unistd.h>

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

}  // namespace
}  // namespace bodyloom::training_test
