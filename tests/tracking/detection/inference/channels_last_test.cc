// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/channels_last.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "tests/tracking/detection/inference/onnx_writer.h"
#include "tracking/detection/inference/graph_executor.h"
#include "tracking/detection/inference/onnx_reader.h"

namespace bodyloom::channels_last_test {
namespace {

using Writer = OnnxWriter;

std::vector<float> RandomNumbers(size_t count, unsigned seed, float scale = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-scale, scale);
  std::vector<float> numbers(count);
  std::generate(numbers.begin(), numbers.end(), [&] { return uniform(random); });
  return numbers;
}

/// The slow twin: every node as a network of its own, all but its first image as constants, so that nothing is laid out
/// anew between them.
std::map<int, GraphTensor> RunNodeByNode(const OperatorGraph& graph, const GraphTensor& input) {
  std::map<int, GraphTensor> values = {{graph.inputs[0], input}};
  for (size_t i = 0; i < graph.tensors.size(); ++i) {
    if (graph.tensors[i].constant.has_numbers()) values[int(i)] = graph.tensors[i].constant;
  }
  for (const GraphNode& node : graph.nodes) {
    OperatorGraph alone;
    alone.name = node.name;
    alone.opset = graph.opset;
    GraphNode copy = node;
    GraphTensor first;
    for (int& tensor : copy.inputs) {
      if (tensor < 0) continue;
      const bool is_computed = !graph.tensors[size_t(tensor)].constant.has_numbers();
      const GraphTensor& value = values.at(tensor);
      tensor = int(alone.tensors.size());
      alone.tensors.push_back({"in", value.shape, value});
      if (is_computed && alone.inputs.empty()) {
        alone.inputs = {tensor};
        alone.tensors.back().constant = {};
        first = value;
      }
    }
    for (int& tensor : copy.outputs) {
      tensor = int(alone.tensors.size());
      alone.tensors.push_back({"out", {}, {}});
      alone.outputs.push_back(tensor);
    }
    alone.nodes = {copy};
    const std::vector<GraphTensor> outputs = GraphExecutor(alone).Run(first.floats.Copy());
    for (size_t i = 0; i < outputs.size(); ++i) values[node.outputs[i]] = outputs[i];
  }
  return values;
}

void ExpectSame(const Writer& writer, const std::vector<int64_t>& shape) {
  const OperatorGraph graph = ParseOnnxGraph(writer.Bytes(), "net.onnx");
  EXPECT_TRUE(WithChannelsLast(graph).channels_last);
  const std::vector<float> input = RandomNumbers(GraphShapeSize(shape), 7);
  const std::map<int, GraphTensor> expected = RunNodeByNode(graph, {shape, input});
  const std::vector<GraphTensor> outputs = GraphExecutor(graph).Run(input);
  ASSERT_EQ(outputs.size(), graph.outputs.size());
  for (size_t i = 0; i < outputs.size(); ++i) {
    const GraphTensor& truth = expected.at(graph.outputs[i]);
    ASSERT_EQ(outputs[i].shape, truth.shape) << graph.tensors[size_t(graph.outputs[i])].name;
    for (size_t k = 0; k < truth.size(); ++k) {
      ASSERT_NEAR(outputs[i].floats[k], truth.floats[k], 2e-5 * std::max(1.0F, std::abs(truth.floats[k])))
          << graph.tensors[size_t(graph.outputs[i])].name << ", number " << k;
    }
  }
}

Writer& AddConvolution(const std::string& from, int64_t in, int64_t out, const std::string& to, Writer* writer,
                       int64_t size = 3, int64_t groups = 1) {
  const int64_t in_group = in / groups, pad = size / 2;
  writer->Floats(to + ".w", {out, in_group, size, size},
                 RandomNumbers(size_t(out * in_group * size * size), unsigned(out + in), 0.4F));
  writer->Floats(to + ".b", {out}, RandomNumbers(size_t(out), 3));
  return writer->Node("Conv", {from, to + ".w", to + ".b"}, {to},
                      {Writer::Integers("pads", {pad, pad, pad, pad}), Writer::Integer("group", groups)});
}

TEST(ChannelsLast, ANetworkOfMostOperatorsGivesTheSame) {
  Writer w;
  w.Input("x", {2, 3, 6, 10});
  AddConvolution("x", 3, 8, "c1", &w).Node("Sigmoid", {"c1"}, {"s"}).Node("Mul", {"c1", "s"}, {"swish"});
  w.Node("MaxPool", {"swish"}, {"pooled"},
         {Writer::Integers("kernel_shape", {2, 2}), Writer::Integers("strides", {2, 2})});
  w.Ints("halves", {2}, {3, 5}).Node("Split", {"pooled", "halves"}, {"three", "five"}, {Writer::Integer("axis", 1)});
  AddConvolution("five", 5, 5, "by channel", &w, 3, 5);
  w.Node("Concat", {"by channel", "three", "five"}, {"joined"}, {Writer::Integer("axis", -3)});
  w.Floats("of channel", {13, 1, 1}, RandomNumbers(13, 5)).Node("Add", {"joined", "of channel"}, {"shifted"});
  w.Floats("slope", {13, 1, 1}, RandomNumbers(13, 6)).Node("PRelu", {"shifted", "slope"}, {"bent"});
  w.Floats("of column", {5}, RandomNumbers(5, 8)).Node("Mul", {"bent", "of column"}, {"by column"});
  w.Floats("half", {}, {0.5F}).Node("Mul", {"half", "by column"}, {"halved"});
  w.Node("GlobalAveragePool", {"halved"}, {"means"});
  AddConvolution("means", 13, 13, "excited", &w, 1).Node("HardSigmoid", {"excited"}, {"gate"});
  w.Node("Mul", {"halved", "gate"}, {"gated"});
  w.Node("ReduceMean", {"gated"}, {"mean"}, {Writer::Integers("axes", {-2, 3})})
      .Node("Sub", {"gated", "mean"}, {"centred"});
  w.Ints("pads", {8}, {0, 0, 1, 0, 0, 0, 0, 2}).Node("Pad", {"centred", "pads"}, {"padded"});
  for (const char* of : {"scale", "offset", "middle"}) w.Floats(of, {13}, RandomNumbers(13, 9));
  std::vector<float> variance = RandomNumbers(13, 10);
  for (float& v : variance) v = 1 + v * v;
  w.Floats("variance", {13}, variance);
  w.Node("BatchNormalization", {"padded", "scale", "offset", "middle", "variance"}, {"normal"});
  w.Floats("factors", {4}, {1, 1, 2, 3})
      .Node("Resize", {"normal", "", "factors"}, {"large"},
            {Writer::Text("mode", "nearest"), Writer::Text("coordinate_transformation_mode", "asymmetric"),
             Writer::Text("nearest_mode", "floor")});
  AddConvolution("large", 13, 4, "c2", &w, 1).Node("Relu", {"c2"}, {"positive"});
  w.Ints("flat", {3}, {2, 4, -1}).Node("Reshape", {"positive", "flat"}, {"row"});
  w.Node("Softmax", {"row"}, {"shares"}, {Writer::Integer("axis", 1)});
  w.Node("ReduceMax", {"gated"}, {"largest"}, {Writer::Integers("axes", {1}), Writer::Integer("keepdims", 0)});
  for (const char* output : {"shares", "swish", "gated", "largest", "large", "mean", "x"}) w.Output(output);
  w.opset = 13;
  ExpectSame(w, {2, 3, 6, 10});
}

TEST(ChannelsLast, AnImageOfComputedOrderIsTurnedBack) {
  Writer w;  // a sum of two images, of which one came through a transposition
  w.Input("x", {1, 4, 4, 4});
  AddConvolution("x", 4, 4, "c", &w, 1);
  w.Node("Transpose", {"c"}, {"turned"}, {Writer::Integers("perm", {0, 2, 1, 3})});
  w.Node("Add", {"c", "turned"}, {"sum"}).Node("Concat", {"sum", "c"}, {"both"}, {Writer::Integer("axis", 1)});
  w.Node("Concat", {"c", "c"}, {"tall"}, {Writer::Integer("axis", 2)}).Output("tall");
  AddConvolution("both", 8, 2, "y", &w, 3).Output("y").Output("sum");
  ExpectSame(w, {1, 4, 4, 4});
}

TEST(ChannelsLast, ConstantNodesAreConstants) {
  Writer w;
  w.Input("x", {1, 2, 3, 5});
  AddConvolution("x", 2, 3, "c", &w, 1);
  w.Node("Constant", {}, {"k"},
         {Writer::TensorOf("value", Writer::Tensor<float>("", Writer::kFloat, {1, 3, 1, 1}, {2, 3, 4}))});
  w.Node("Mul", {"c", "k"}, {"y"}).Output("y");
  const OperatorGraph last = WithChannelsLast(ParseOnnxGraph(w.Bytes(), "net.onnx"));
  EXPECT_EQ(
      std::count_if(last.nodes.begin(), last.nodes.end(), [](const auto& node) { return node.op == "Transpose"; }), 3)
      << "of the image, the weights and the result";
  const std::vector<float> input = RandomNumbers(30, 1);
  const std::vector<GraphTensor> outputs = GraphExecutor(ParseOnnxGraph(w.Bytes(), "net.onnx")).Run(input);
  Writer plain;
  plain.Input("x", {1, 2, 3, 5});
  AddConvolution("x", 2, 3, "c", &plain, 1).Output("c");
  const std::vector<GraphTensor> unscaled = GraphExecutor(ParseOnnxGraph(plain.Bytes(), "net.onnx")).Run(input);
  for (size_t i = 0; i < 45; ++i) {
    EXPECT_NEAR(outputs[0].floats[i], float(2 + i / 15) * unscaled[0].floats[i], 1e-5);
  }
}

TEST(ChannelsLast, AShapeIsThatOfTheFile) {
  Writer w;  // 1×3×2×5 pixels as 3 rows of 10, by their computed shape
  w.Input("x", {1, 3, 2, 5});
  AddConvolution("x", 3, 3, "c", &w, 1).Node("Shape", {"c"}, {"shape"});
  w.Ints("one", {1}, {1}).Node("Gather", {"shape", "one"}, {"channels"}).Ints("rest", {1}, {-1});
  w.Node("Concat", {"channels", "rest"}, {"rows"}, {Writer::Integer("axis", 0)});
  w.Node("Reshape", {"c", "rows"}, {"y"}).Output("y").Output("c");
  const OperatorGraph graph = ParseOnnxGraph(w.Bytes(), "net.onnx");
  const std::vector<GraphTensor> outputs = GraphExecutor(graph).Run(RandomNumbers(30, 2));
  EXPECT_EQ(outputs[0].shape, (std::vector<int64_t>{3, 10}));
  EXPECT_EQ(outputs[0].floats, outputs[1].floats);
}

TEST(ChannelsLast, GraphsThatItCannotServeStayAsTheyAre) {
  const auto stays = [](const Writer& writer) {
    const OperatorGraph graph = ParseOnnxGraph(writer.Bytes(), "net.onnx"), same = WithChannelsLast(graph);
    return !same.channels_last && same.nodes.size() == graph.nodes.size();
  };
  Writer none;
  none.Input("x", {1, 2, 3, 3}).Node("Relu", {"x"}, {"y"}).Output("y");
  EXPECT_TRUE(stays(none));
  Writer grouped;
  grouped.Input("x", {1, 4, 3, 3});
  AddConvolution("x", 4, 4, "y", &grouped, 3, 2).Output("y");
  EXPECT_TRUE(stays(grouped));
  Writer resized;
  resized.Input("x", {1, 2, 3, 3});
  AddConvolution("x", 2, 2, "c", &resized, 1).Node("Shape", {"c"}, {"size"});
  resized.Node("Resize", {"c", "", "", "size"}, {"y"}, {Writer::Text("mode", "nearest")}).Output("y");
  EXPECT_TRUE(stays(resized));
}

}  // namespace
}  // namespace bodyloom::channels_last_test
