// SPDX-License-Identifier: Apache-2.0
// The built-in weights are those of the recorded run (checksums: tests/CMakeLists.txt): they hold the run's
// configuration and reproduce the errors of its last validation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "data_tools/body/builtin_body.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/motion/motion_library.h"
#include "data_tools/synthesis/lifter/lifter_windows.h"
#include "tests/support/paths.h"
#include "tracking/lifter/lifter_network.h"
#include "tracking/lifter/lifter_reading.h"

namespace bodyloom::lifter_record_test {
namespace {

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
}  // namespace bodyloom::lifter_record_test
