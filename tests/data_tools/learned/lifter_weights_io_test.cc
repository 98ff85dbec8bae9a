// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

#include "data_tools/learned/lifter_weights_io.h"

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "data_tools/motion/motion_library.h"
#include "data_tools/synthesis/lifter/lifter_windows.h"
#include "tests/support/paths.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/lifter/lifter_network.h"
#include "tracking/lifter/lifter_reading.h"

namespace bodyloom::lifter_weights_io_test {
namespace {

LifterWeights SmallWeights() {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  const auto fill = [&](auto* array, Eigen::Index rows, Eigen::Index cols) {
    array->resize(rows, cols);
    for (Eigen::Index i = 0; i < array->size(); ++i) array->data()[i] = normal(random);
  };
  LifterWeights weights;
  fill(&weights.input, 6, 3 * 5);
  fill(&weights.input_bias, 6, 1);
  for (const int dilation : {1, 4}) {
    LifterWeights::Block& block = weights.blocks.emplace_back();
    block.dilation = dilation;
    fill(&block.norm_scale, 6, 1);
    fill(&block.norm_shift, 6, 1);
    fill(&block.dilated, 6, 18);
    fill(&block.dilated_bias, 6, 1);
    fill(&block.mix, 6, 6);
    fill(&block.mix_bias, 6, 1);
  }
  fill(&weights.norm_scale, 6, 1);
  fill(&weights.norm_shift, 6, 1);
  fill(&weights.output, LifterOutput::kSize, 6);
  fill(&weights.output_bias, LifterOutput::kSize, 1);
  weights.recipe = "made up for a test";
  return weights;
}

std::string TestPath(const std::string& name) { return (std::filesystem::path(testing::TempDir()) / name).string(); }

std::string Bytes(const LifterWeights& weights) {
  const std::string path = TestPath("lifter_weights.npz");
  WriteLifterWeights(path, weights);
  return ReadFileBytes(path);
}

/// "" when it reads.
std::string ErrorOf(const std::string& bytes) {
  try {
    ReadLifterWeightsBytes(bytes, "some/lifter.npz");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(LifterWeightsIo, MatricesComeBackToElevenBitsVectorsExactly) {
  const LifterWeights written = SmallWeights(), read = ReadLifterWeightsBytes(Bytes(written), "x");
  ASSERT_EQ(read.blocks.size(), 2U);
  EXPECT_EQ(read.recipe, written.recipe);
  EXPECT_EQ(read.reach(), 6);
  EXPECT_EQ(read.num_parameters(), written.num_parameters());
  EXPECT_TRUE(read.input_bias == written.input_bias);
  EXPECT_TRUE(read.blocks[1].norm_shift == written.blocks[1].norm_shift);
  EXPECT_EQ(read.blocks[1].dilation, 4);
  for (Eigen::Index i = 0; i < written.output.size(); ++i) {
    const float w = written.output.data()[i];
    EXPECT_LE(std::abs(read.output.data()[i] - w), std::abs(w) / 2048 + 1e-7F);
  }
  EXPECT_EQ(Bytes(read), Bytes(ReadLifterWeightsBytes(Bytes(read), "x"))) << "what was read is written as it was";
}

TEST(LifterWeightsIo, TruncatedFilesAreNamed) {
  const std::string bytes = Bytes(SmallWeights());
  for (size_t size = 0; size < bytes.size(); size += 1 + size / 61) {
    const std::string error = ErrorOf(bytes.substr(0, size));
    EXPECT_NE(error.find("some/lifter.npz"), std::string::npos) << size << ": " << error;
  }
}

TEST(LifterWeightsIo, FlippedBytesNeverCrash) {
  const std::string bytes = Bytes(SmallWeights());
  for (size_t at = 0; at < bytes.size(); at += 7) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x5a);
    const std::string error = ErrorOf(damaged);
    if (!error.empty()) {
      EXPECT_NE(error.find("some/lifter.npz"), std::string::npos) << error;
    }
  }
}

TEST(LifterWeightsIo, ContradictionsAreNamed) {
  const NpzArrays good = ReadNpzBytes(Bytes(SmallWeights()), "x");
  const auto error_with = [&](const std::function<void(NpzArrays*)>& change) {
    NpzArrays arrays = good;
    change(&arrays);
    return ErrorOf(NpzBytes(arrays));
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  for (const auto& [name, array] : good) {
    has(error_with([&, key = name](NpzArrays* a) { a->erase(key); }), name);
  }
  const float nan = std::nanf("");
  has(error_with(
          [&](NpzArrays* a) { (*a)["norm_scale"] = NdArray::FromFloats(std::vector<float>(6, nan).data(), {6}); }),
      "norm_scale holds numbers that are not finite");
  has(error_with([&](NpzArrays* a) { (*a)["norm_scale"] = NdArray::FromFloats(std::vector<float>(5).data(), {5}); }),
      "norm_scale is 5x1, expected 6x1");
  const int32_t zero[2] = {1, 0};
  has(error_with([&](NpzArrays* a) { (*a)["dilations"] = NdArray::FromInts32(zero, {2}); }), "block1.dilation is 0");
  const std::vector<int32_t> many(1000, 1);
  has(error_with([&](NpzArrays* a) { (*a)["dilations"] = NdArray::FromInts32(many.data(), {1000}); }), "1000 blocks");
  has(error_with([&](NpzArrays* a) { (*a)["output"] = NdArray::FromString("text"); }), "output");
}

TEST(LifterWeightsIo, WeightsThatAreNotValidAreNotWritten) {
  LifterWeights weights = SmallWeights();
  weights.blocks[0].mix.resize(3, 3);
  EXPECT_THROW(WriteLifterWeights(TestPath("never.npz"), weights), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(TestPath("never.npz")));
}

TEST(BuiltinLifter, ReadsWhatTheTrackerFeedsIt) {
  const LifterWeights& weights = BuiltinLifter();
  EXPECT_EQ(weights.num_inputs(), kLifterInputs);
  EXPECT_FALSE(weights.recipe.empty());
  EXPECT_LT(std::filesystem::file_size(std::filesystem::path(SourceDir()) / "assets/lifter/lifter.npz"), 4U << 20);
}

const std::string kRun = SourceDir() + "/assets/lifter/run";

/// The last line of metrics.csv, by column.
std::map<std::string, double> LastMetrics() {
  std::ifstream file(kRun + "/metrics.csv");
  std::string header, line, last;
  std::getline(file, header);
  while (std::getline(file, line)) last = line;
  std::map<std::string, double> result;
  std::istringstream names(header), values(last);
  for (std::string name, value; std::getline(names, name, ',') && std::getline(values, value, ',');) {
    result[name] = value.empty() ? std::nan("") : std::stod(value);
  }
  return result;
}

// The built-in weights are those of the recorded run (checksums: tests/CMakeLists.txt): they hold the run's
// configuration and reproduce the errors of its last validation.

TEST(LifterRecord, TheWeightsCarryTheRunsConfiguration) {
  std::ifstream file(kRun + "/config.json");
  const auto config = nlohmann::ordered_json::parse(file);
  EXPECT_EQ(BuiltinLifter().recipe, config.dump());
  EXPECT_EQ(BuiltinLifter().width(), config["channels"].get<int>());
  EXPECT_EQ(LastMetrics()["step"], config["steps"].get<double>());
}

TEST(LifterRecord, TheWeightsMakeTheErrorsThatTheRunWroteDown) {
  const std::string folder = SharedDir() + "/data/motion";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there: no motion to validate on";
  MotionLibraryOptions library;
  library.visit_train = false;
  library.split_path = kRun + "/motion_split.txt";
  std::vector<Motion> motions;
  std::vector<char> has_floor;
  VisitMotionLibrary({folder}, library, [&](LibraryClip&& clip) {
    has_floor.push_back(clip.has_floor);
    motions.push_back(std::move(clip.motion));
  });
  const LifterWindowGenerator generator(motions, has_floor, BuiltinBody(), LifterWindowOptions::AsRecorded());
  constexpr int kWindows = 256;
  double sum = 0;
  LifterWindow window;
  for (int i = 0; i < kWindows; ++i) {
    generator.Generate((uint64_t{1} << 62) + i, &window);  // the seeds of neural/lifter/train_lifter.cc
    const auto T = static_cast<Eigen::Index>(window.features.size() / kLifterInputs);
    const RowMatrixXf output =
        RunLifter(BuiltinLifter(), Eigen::Map<const RowMatrixXf>(window.features.data(), T, kLifterInputs));
    for (Eigen::Index t = 0; t < T; ++t) {
      LiftedFrame frame = ReadLifter(output, {}, t, Eigen::Matrix3d::Identity());
      for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {  // the run wrote down the likeliest hypotheses' error
        const std::vector<LiftedLimb> guesses = frame.limbs[limb];
        SetLimb(limb,
                *std::max_element(guesses.begin(), guesses.end(),
                                  [](const LiftedLimb& a, const LiftedLimb& b) { return a.weight < b.weight; }),
                &frame);
      }
      const Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>> truth(
          &window.points[size_t(t) * 3 * kLifterPoints], kLifterPoints, 3);
      sum += (frame.points - truth.cast<double>()).rowwise().norm().mean() / static_cast<double>(T);
    }
  }
  const double recorded = LastMetrics()["validation_distance"];
  RecordProperty("distance", std::to_string(sum / kWindows));
  // The file holds half precision; other weights (a tenth of a run) are off by a fifth.
  EXPECT_NEAR(sum / kWindows, recorded, 0.01 * recorded);
}

}  // namespace

}  // namespace bodyloom::lifter_weights_io_test
