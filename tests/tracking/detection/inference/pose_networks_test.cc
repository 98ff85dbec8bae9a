// SPDX-License-Identifier: Apache-2.0
/// Networks of body, hands and face against TensorFlow Lite's results for a synthetic input: value k = (7·row +
/// 13·column + 29·channel) mod 256, as k/255 for the landmarks and k/127.5 − 1 for the detector (docs/lab/hands.md).
/// Skipped without the networks (`./dev models`).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/tracking/detection/inference/tflite_reference.h"
#include "tracking/detection/inference/graph_executor.h"
#include "tracking/detection/inference/tflite_reader.h"
#include "tracking/detection/model_files.h"

namespace bodyloom::pose_networks_test {
namespace {

std::optional<OperatorGraph> ModelIfThere(const std::string& file) {
  std::string path;
  try {
    path = FindModelFile(file);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
  return ReadTfliteGraph(path);
}

std::vector<float> Pattern(const std::vector<int64_t>& shape, bool detector) {
  std::vector<float> values;
  for (int row = 0; row < shape[1]; ++row) {
    for (int column = 0; column < shape[2]; ++column) {
      for (int channel = 0; channel < shape[3]; ++channel) {
        const auto k = static_cast<float>((7 * row + 13 * column + 29 * channel) % 256);
        values.push_back(detector ? k / 127.5F - 1 : k / 255);
      }
    }
  }
  return values;
}

/// Of the file, where relu6 is part of the operator before.
size_t NumOperators(const OperatorGraph& graph) {
  return graph.nodes.size() - static_cast<size_t>(std::count_if(graph.nodes.begin(), graph.nodes.end(),
                                                                [](const GraphNode& n) { return n.op == "Clip"; }));
}

struct Spread {
  double mean, deviation;
};

void ExpectSpread(const GraphTensor& output, const Spread& expected, double tolerance, const std::string& what) {
  double mean = 0, square = 0;
  for (const float value : output.floats) mean += value;
  mean /= static_cast<double>(output.floats.size());
  for (const float value : output.floats) square += (value - mean) * (value - mean);
  EXPECT_NEAR(mean, expected.mean, tolerance) << what;
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(output.floats.size())), expected.deviation, tolerance) << what;
}

void ExpectFirst(const GraphTensor& output, const std::vector<double>& expected, double tolerance,
                 const std::string& what) {
  for (size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(output.floats[i], expected[i], tolerance) << what << " " << i;
}

TEST(PoseNetworks, Detector) {
  const std::optional<OperatorGraph> model = ModelIfThere(kPoseDetectorFile);
  if (!model) GTEST_SKIP() << kPoseDetectorFile << " is not there; ./dev models fetches it";
  EXPECT_EQ(NumOperators(*model), 109U);
  GraphExecutor network(*model);
  ASSERT_EQ(network.input_shape(), (std::vector<int64_t>{1, 224, 224, 3}));
  const std::vector<GraphTensor> outputs = network.Run(Pattern(network.input_shape(), true));
  ASSERT_EQ(outputs.size(), 2U);
  ASSERT_EQ(outputs[0].shape, (std::vector<int64_t>{1, 2254, 12}));
  ASSERT_EQ(outputs[1].shape, (std::vector<int64_t>{1, 2254, 1}));
  ExpectSpread(outputs[0], {-1.90978, 66.98011}, 5e-5, "boxes");
  ExpectSpread(outputs[1], {-56.87803, 63.75568}, 5e-5, "scores");
  ExpectFirst(outputs[0], {0.0886, -3.5152, 5.2196, -0.3981}, 1e-3, "boxes");
  ExpectFirst(outputs[1], {-84.1387, -6.1739, -101.0979, -7.4267}, 1e-3, "scores");
}

struct Landmarks {
  const char* file;
  size_t operators;
  Spread points;
  std::vector<double> first;
  double presence;
  Spread mask, heatmap, world;
};

// Tolerances: what TensorFlow Lite's own builds differ by on a pattern like this (4e-3 crop pixels, 0.6 mask logits,
// 7e-4 heatmap logits). Single numbers are compared with exact sums below.
void ExpectLandmarks(const Landmarks& expected) {
  const std::optional<OperatorGraph> model = ModelIfThere(expected.file);
  if (!model) GTEST_SKIP() << expected.file << " is not there; ./dev models fetches it";
  const std::string what = expected.file;
  EXPECT_EQ(NumOperators(*model), expected.operators) << what;
  GraphExecutor network(*model);
  ASSERT_EQ(network.input_shape(), (std::vector<int64_t>{1, 256, 256, 3}));
  const std::vector<float> input = Pattern(network.input_shape(), false);
  const std::vector<GraphTensor> outputs = network.Run(input);
  const std::vector<std::vector<int64_t>> shapes = {{1, 195}, {1, 1}, {1, 256, 256, 1}, {1, 64, 64, 39}, {1, 117}};
  ASSERT_EQ(outputs.size(), shapes.size());
  for (size_t i = 0; i < shapes.size(); ++i) ASSERT_EQ(outputs[i].shape, shapes[i]) << what;
  ExpectSpread(outputs[0], expected.points, 1e-3, what + " points");
  ExpectFirst(outputs[0], expected.first, 4e-3, what + " points");
  ExpectFirst(outputs[1], {expected.presence}, 1e-4, what + " presence");
  ExpectSpread(outputs[2], expected.mask, 5e-3, what + " mask");
  ExpectSpread(outputs[3], expected.heatmap, 1e-4, what + " heatmap");
  ExpectSpread(outputs[4], expected.world, 2e-5, what + " world");

  // Without the mask's branch, in two threads at once: the same bits.
  std::vector<std::vector<GraphTensor>> without(2);
  std::vector<std::thread> threads;
  threads.reserve(without.size());
  for (std::vector<GraphTensor>& own : without) {
    threads.emplace_back([&] {
      const GraphExecutor branch(*model, {}, {0, 1, 3, 4});
      EXPECT_LT(branch.num_steps(), network.num_steps()) << what;
      for (int run = 0; run < 2; ++run) own = branch.Run(input);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<GraphTensor>& own : without) {
    ASSERT_EQ(own.size(), 4U);
    for (size_t i = 0; i < 4; ++i) EXPECT_EQ(own[i].floats, outputs[i < 2 ? i : i + 1].floats) << what << " " << i;
  }
}

/// Every number of every output against plain loops whose sums are in double precision.
TEST(PoseNetworks, LiteAsExactSumsGiveIt) {
  const std::optional<OperatorGraph> model = ModelIfThere(kPoseLandmarkLiteFile);
  if (!model) GTEST_SKIP() << kPoseLandmarkLiteFile << " is not there; ./dev models fetches it";
  GraphExecutor network(*model);
  const std::vector<float> input = Pattern(network.input_shape(), false);
  const std::vector<std::vector<float>> exact = RunReference(*model, input);
  const std::vector<GraphTensor> outputs = network.Run(input);
  // Crop pixels, probability, logits of mask and heatmaps, metres; rounding on noise, amplified by 60 layers.
  const double tolerances[] = {4e-3, 1e-5, 0.6, 7e-4, 2e-5};
  ASSERT_EQ(outputs.size(), std::size(tolerances));
  for (size_t i = 0; i < outputs.size(); ++i) {
    const std::vector<float>& expected = exact[static_cast<size_t>(model->outputs[i])];
    ASSERT_EQ(outputs[i].floats.size(), expected.size());
    double largest = 0;
    for (size_t j = 0; j < expected.size(); ++j) {
      largest = std::max(largest, std::abs(static_cast<double>(expected[j]) - outputs[i].floats[j]));
    }
    EXPECT_LT(largest, tolerances[i]) << "output " << i;
  }
}

TEST(PoseNetworks, Lite) {
  ExpectLandmarks({kPoseLandmarkLiteFile,
                   129,
                   {49.72257, 67.93967},
                   {134.224, 98.1994, -46.5972, -2.493},
                   0.0,
                   {-56.64063, 30.37614},
                   {-7.60897, 6.29151},
                   {-0.05248, 0.26141}});
}

TEST(PoseNetworks, Full) {
  ExpectLandmarks({kPoseLandmarkFullFile,
                   140,
                   {35.02411, 58.32686},
                   {110.1057, 36.4751, -55.3545, -0.5243},
                   0.1053,
                   {-45.07447, 149.25655},
                   {-7.57063, 4.94127},
                   {-0.11560, 0.22635}});
}

TEST(PoseNetworks, Heavy) {
  ExpectLandmarks({kPoseLandmarkHeavyFile,
                   293,
                   {50.34144, 73.70656},
                   {129.8806, 157.3062, -0.1647, -11.6031},
                   0.2997,
                   {-28.53919, 12.92596},
                   {-10.34958, 8.32931},
                   {0.05565, 0.56821}});
}

struct SmallNetwork {
  const char* file;
  size_t operators;
  int64_t side;
  std::vector<Spread> spreads;             ///< of each output
  std::vector<std::vector<double>> first;  ///< numbers of each
  std::vector<double> tolerances;
};

void ExpectSmallNetwork(const SmallNetwork& expected) {
  const std::optional<OperatorGraph> model = ModelIfThere(expected.file);
  if (!model) GTEST_SKIP() << expected.file << " is not there; ./dev models fetches it";
  EXPECT_EQ(NumOperators(*model), expected.operators);
  const GraphExecutor network(*model);
  ASSERT_EQ(network.input_shape(), (std::vector<int64_t>{1, expected.side, expected.side, 3}));
  const std::vector<float> input = Pattern(network.input_shape(), false);
  const std::vector<GraphTensor> outputs = network.Run(input);
  const std::vector<std::vector<float>> exact = RunReference(*model, input);
  ASSERT_EQ(outputs.size(), expected.spreads.size());
  for (size_t i = 0; i < outputs.size(); ++i) {
    const std::string what = Concatenate(expected.file, " output ", i);
    ExpectSpread(outputs[i], expected.spreads[i], 1e-4, what);
    ExpectFirst(outputs[i], expected.first[i], expected.tolerances[i], what);
    const std::vector<float>& sums = exact[static_cast<size_t>(model->outputs[i])];
    ASSERT_EQ(outputs[i].floats.size(), sums.size());
    for (size_t j = 0; j < sums.size(); ++j) EXPECT_NEAR(outputs[i].floats[j], sums[j], expected.tolerances[i]) << what;
  }
}

TEST(PoseNetworks, HandLandmarks) {
  ExpectSmallNetwork({kHandLandmarkFile,
                      63,
                      224,
                      {{72.03399, 50.32606}, {0.00576, 0}, {0.70485, 0}, {-0.00078, 0.02291}},
                      {{112.44524, 171.98097, 0.0, 106.49697, 155.80685, 2.91779},
                       {0.00576},
                       {0.70485},
                       {-0.00289, 0.05152, 0.06711, -0.00211, 0.03616, 0.06231}},
                      {1e-3, 1e-5, 1e-5, 1e-5}});
}

TEST(PoseNetworks, HandRegion) {
  ExpectSmallNetwork(
      {kHandRegionFile, 63, 256, {{149.82664, 33.34831}}, {{131.74872, 120.04915, 141.42900, 206.07971}}, {1e-3}});
}

TEST(PoseNetworks, FaceLandmarks) {
  ExpectSmallNetwork({kFaceLandmarkFile,
                      97,
                      192,
                      {{64.97704, 51.43574}, {-10.00724, 0}},
                      {{89.62776, 124.86030, -6.42849, 93.07915, 114.68202, -18.35137}, {-10.00724}},
                      {1e-3, 1e-4}});
}

TEST(PoseNetworks, HowManyThreadsOpenCvUsesChangesRoundingAlone) {
  const int before = cv::getNumThreads();
  for (const char* file : {kPoseDetectorFile, kPoseLandmarkLiteFile, kPoseLandmarkFullFile}) {
    const std::optional<OperatorGraph> model = ModelIfThere(file);
    if (!model) GTEST_SKIP() << file << " is not there; ./dev models fetches it";
    std::vector<GraphTensor> expected;
    for (const int threads : {1, 2, 3}) {
      cv::setNumThreads(threads);
      GraphExecutor network(*model);
      std::vector<GraphTensor> outputs = network.Run(Pattern(network.input_shape(), false));
      for (size_t i = 0; i < expected.size(); ++i) {
        float largest = 0;
        for (size_t j = 0; j < expected[i].floats.size(); ++j) {
          largest = std::max(largest, std::abs(outputs[i].floats[j] - expected[i].floats[j]));
        }
        EXPECT_LT(largest, 2e-3F) << file << " output " << i << ", " << threads << " threads";
      }
      expected = std::move(outputs);
    }
  }
  cv::setNumThreads(before);
}

TEST(PoseNetworks, CutDetector) {
  if (!ModelIfThere(kPoseDetectorFile)) GTEST_SKIP() << kPoseDetectorFile << " is not there; ./dev models fetches it";
  const std::string bytes = ReadFileBytes(FindModelFile(kPoseDetectorFile));
  for (size_t length = 0; length < bytes.size(); length += bytes.size() / 100) {
    FileErrorOf("cut", [&] { ParseTfliteGraph(std::string_view(bytes).substr(0, length), "cut"); });
  }
}

}  // namespace
}  // namespace bodyloom::pose_networks_test
