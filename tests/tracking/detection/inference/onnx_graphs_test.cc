// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/graph_executor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/tracking/detection/inference/onnx_writer.h"
#include "tests/tracking/detection/inference/small_onnx.h"
#include "tracking/detection/inference/onnx_reader.h"

namespace bodyloom::onnx_graphs_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Writer = OnnxWriter;

GraphExecutor NetworkOf(const Writer& writer, std::vector<int64_t> shape) {
  return GraphExecutor(ParseOnnxGraph(writer.Bytes(), "net.onnx"), std::move(shape));
}

std::string RefusalOf(const Writer& writer, const std::vector<int64_t>& shape) {
  return FileErrorOf("net.onnx: ", [&] { NetworkOf(writer, shape); });
}

TEST(OnnxGraphs, ComputesWhatHangsOnTheImage) {
  Writer writer;
  writer.Input("x", {1, 2}).Floats("two", {}, {2}).Floats("w", {2}, {10, 20});
  writer.Node("Mul", {"two", "w"}, {"constant"}).Node("Add", {"x", "constant"}, {"y"});
  writer.Node("Neg", {"y"}, {"z"}).Output("z").Output("y");
  const GraphExecutor network = NetworkOf(writer, {1, 2});
  EXPECT_THAT(network.output_shapes(), ElementsAre(ElementsAre(1, 2), ElementsAre(1, 2)));
  for (int i = 0; i < 2; ++i) {
    const std::vector<GraphTensor> outputs = network.Run({1, 2});
    EXPECT_THAT(outputs[0].floats, ElementsAre(-21, -42));
    EXPECT_THAT(outputs[1].floats, ElementsAre(21, 42));
  }
  EXPECT_THROW(network.Run({1, 2, 3}), std::invalid_argument);
}

/// 3 × 3 × 3 pixels through a 1 × 1 convolution that sums the planes, then x · sigmoid(x) in one of two orders.
TEST(OnnxGraphs, SwishBehindAConvolution) {
  for (const bool swapped : {false, true}) {
    for (const bool seen : {false, true}) {  // whether somebody else reads the convolution's result
      Writer writer;
      writer.Input("x", {1, 3, 1, 2}).Floats("w", {1, 3, 1, 1}, {1, 1, 1});
      writer.Node("Conv", {"x", "w"}, {"c"}).Node("Sigmoid", {"c"}, {"s"});
      writer.Node("Mul", swapped ? std::vector<std::string>{"s", "c"} : std::vector<std::string>{"c", "s"}, {"y"});
      writer.Output("y");
      if (seen) writer.Output("c");
      const std::vector<GraphTensor> outputs = NetworkOf(writer, {1, 3, 1, 2}).Run({1, -1, 1, 0, 1, -1});
      EXPECT_NEAR(outputs[0].floats[0], 3 / (1 + std::exp(-3.0)), 1e-5);
      EXPECT_NEAR(outputs[0].floats[1], -2 / (1 + std::exp(2.0)), 1e-5);
      if (seen) {
        EXPECT_THAT(outputs[1].floats, ElementsAre(3, -2));
      }
    }
  }
}

TEST(OnnxGraphs, SigmoidOfSomethingElseIsNoSwish) {
  Writer writer;
  writer.Input("x", {1, 1, 1, 1}).Floats("w", {1, 1, 1, 1}, {2}).Node("Sigmoid", {"x"}, {"s"});
  writer.Node("Conv", {"x", "w"}, {"c"}).Node("Mul", {"c", "s"}, {"y"}).Output("y");
  EXPECT_NEAR(NetworkOf(writer, {1, 1, 1, 1}).Run({1})[0].floats[0], 2 / (1 + std::exp(-1.0)), 1e-5);
  Writer square;
  square.Input("x", {1, 1, 1, 1}).Floats("w", {1, 1, 1, 1}, {2}).Node("Conv", {"x", "w"}, {"c"});
  square.Node("Mul", {"c", "c"}, {"y"}).Output("y");
  EXPECT_NEAR(NetworkOf(square, {1, 1, 1, 1}).Run({3})[0].floats[0], 36, 1e-4);
}

TEST(OnnxGraphs, ShapesComeAlongWithTheImage) {
  // Softmax of mean · w plus 0, 1: two numbers whose odds are e^(y1 + 1 − y0).
  const GraphExecutor network = NetworkOf(SmallOnnxNetworks()[1], {1, 3, 4, 4});
  std::vector<float> image(48, 0.0F);
  for (size_t i = 0; i < 16; ++i) image[i] = 0.5F;
  const std::vector<GraphTensor> outputs = network.Run(image);
  EXPECT_THAT(outputs[0].shape, ElementsAre(2, 1));
  EXPECT_NEAR(std::log(outputs[0].floats[1] / outputs[0].floats[0]), 1 + 0.5 * (2 - 1), 1e-5);
}

TEST(OnnxGraphs, ThreadsAndCopiesGiveEqualBits) {
  const GraphExecutor network = NetworkOf(SmallOnnxNetworks()[0], {1, 3, 6, 6});
  std::vector<float> image(108);
  for (size_t i = 0; i < image.size(); ++i) image[i] = float(i % 13) / 13;
  const std::vector<float> alone = network.Run(image)[0].floats.Copy();
  std::vector<std::vector<float>> results(4);
  std::vector<std::thread> threads;
  threads.reserve(results.size());
  for (auto& result : results) {
    threads.emplace_back([&result, copy = network, &image] {
      for (int i = 0; i < 20; ++i) result = copy.Run(image)[0].floats.Copy();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_EQ(result, alone);
}

TEST(OnnxGraphs, WhatCannotRunIsNamedWithItsNode) {
  const auto with = [](const std::string& op, const std::vector<std::string>& inputs) {
    return Writer().Input("x", {1, 2}).Floats("w", {3}, {1, 2, 3}).Node(op, inputs, {"y"}).Output("y");
  };
  EXPECT_THAT(RefusalOf(with("NonMaxSuppression", {"x"}), {1, 2}),
              HasSubstr("node '/NonMaxSuppression' (NonMaxSuppression): an operator that is not known here"));
  EXPECT_THAT(RefusalOf(with("Add", {"x", "w"}), {1, 2}), HasSubstr("node '/Add' (Add): shapes 1x2 and 3 do not fit"));
  EXPECT_THAT(RefusalOf(with("Conv", {"w", "x"}), {1, 2}), HasSubstr("weights that are computed"));
  EXPECT_THAT(RefusalOf(with("Conv", {}), {1, 2}), HasSubstr("node '/Conv' (Conv): input 0 is missing"));
  EXPECT_THAT(RefusalOf(with("Shape", {"x"}), {1, 2}), HasSubstr("an output of whole numbers"));
}

TEST(OnnxGraphs, AnotherShapeThanTheModelsIsRefused) {
  EXPECT_THROW(NetworkOf(SmallOnnxNetworks()[0], {1, 3, 8, 8}), std::invalid_argument);
  EXPECT_THROW(NetworkOf(SmallOnnxNetworks()[0], {1, 3, 6}), std::invalid_argument);
  EXPECT_THROW(NetworkOf(SmallOnnxNetworks()[1], {0, 3, 4, 4}), std::invalid_argument);
  EXPECT_NO_THROW(NetworkOf(SmallOnnxNetworks()[1], {2, 3, 4, 4}));
}

}  // namespace
}  // namespace bodyloom::onnx_graphs_test
