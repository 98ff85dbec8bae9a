// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/onnx_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "data_tools/formats/printable.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/tracking/detection/inference/onnx_writer.h"
#include "tests/tracking/detection/inference/small_onnx.h"
#include "tests/tracking/detection/inference/tflite_writer.h"

namespace bodyloom::onnx_reader_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Writer = OnnxWriter;

std::string RefusalOf(const Writer& writer) {
  return FileErrorOf("net.onnx: ", [&] { ParseOnnxGraph(writer.Bytes(), "net.onnx"); });
}

/// One input, one node that passes it on.
Writer Passing() { return Writer().Input("images", {1, 3, 4, 4}).Node("Identity", {"images"}, {"y"}).Output("y"); }

TEST(OnnxReader, HoldsWhatWasWritten) {
  Writer writer;
  writer.opset = 13;
  writer.Input("images", {-1, 3, 8, -1}).Floats("w", {2, 1}, {1.5F, -2});
  writer.Node("Clip", {"images", "", "w"}, {"y", ""},
              {Writer::Integer("axis", -1), Writer::Integers("pads", {1, 2}), Writer::Float("alpha", 0.25F),
               Writer::Text("mode", "nearest"),
               Writer::TensorOf("value", Writer::Tensor<int64_t>("", Writer::kInt64, {}, {7}))});
  writer.Output("y");
  const OperatorGraph model = ParseOnnxGraph(writer.Bytes(), "net.onnx");
  EXPECT_EQ(model.opset, 13);
  EXPECT_THAT(model.tensors[size_t(model.inputs[0])].shape, ElementsAre(-1, 3, 8, -1));
  EXPECT_EQ(model.tensors.size(), 3U);
  ASSERT_EQ(model.nodes.size(), 1U);
  const GraphNode& node = model.nodes[0];
  EXPECT_EQ(node.op, "Clip");
  EXPECT_EQ(node.name, "/Clip");
  ASSERT_EQ(node.inputs.size(), 3U);
  EXPECT_EQ(node.inputs[0], model.inputs[0]);
  EXPECT_EQ(node.inputs[1], -1);
  const GraphTensor& constant = model.tensors.at(size_t(node.inputs[2])).constant;
  EXPECT_THAT(constant.shape, ElementsAre(2, 1));
  EXPECT_THAT(constant.floats, ElementsAre(1.5F, -2));
  EXPECT_EQ(node.outputs[1], -1);
  EXPECT_THAT(model.outputs, ElementsAre(node.outputs[0]));
  EXPECT_EQ(node.Integer("axis", 5), -1);
  EXPECT_EQ(node.Integer("absent", 5), 5);
  EXPECT_THAT(node.Integers("pads", {}), ElementsAre(1, 2));
  EXPECT_EQ(node.Float("alpha", 0), 0.25F);
  EXPECT_EQ(node.Text("mode", ""), "nearest");
  EXPECT_THAT(node.attributes.at("value").tensor.ints, ElementsAre(7));
}

TEST(OnnxReader, NumbersOfAllKinds) {
  Writer writer = Passing();
  writer.graph.Message(5, Writer::Tensor<int32_t>("i32", Writer::kInt32, {2}, {-5, 6}));
  writer.graph.Message(5, Writer::Tensor<uint8_t>("bool", Writer::kBool, {2}, {1, 0}));
  writer.graph.Message(5, Writer::Tensor<uint16_t>("half", Writer::kHalf, {2}, {0x3C00, 0xC000}));
  // One by one rather than as they lie, packed and not.
  const float packed[] = {3, 4};
  writer.graph.Message(5, ProtoWriter().Varint(1, 2).Varint(2, 1).Bytes(8, "list").Bytes(
                              4, {reinterpret_cast<const char*>(packed), sizeof(packed)}));
  writer.graph.Message(
      5, ProtoWriter().Varint(1, 1).Varint(2, 7).Bytes(8, "long").Varint(7, static_cast<uint64_t>(int64_t{-9})));
  const OperatorGraph model = ParseOnnxGraph(writer.Bytes(), "net.onnx");
  std::vector<GraphTensor> constants;
  for (const OperatorGraph::Tensor& tensor : model.tensors) {
    if (tensor.constant.has_numbers()) constants.push_back(tensor.constant);
  }
  ASSERT_EQ(constants.size(), 5U);
  EXPECT_THAT(constants[0].ints, ElementsAre(-5, 6));
  EXPECT_THAT(constants[1].ints, ElementsAre(1, 0));
  EXPECT_THAT(constants[2].floats, ElementsAre(1, -2));
  EXPECT_THAT(constants[3].floats, ElementsAre(3, 4));
  EXPECT_THAT(constants[4].ints, ElementsAre(-9));
}

TEST(OnnxReader, OldFilesListConstantsAmongInputs) {
  Writer writer = Passing().Floats("w", {1}, {1}).Input("w", {1});
  const OperatorGraph graph = ParseOnnxGraph(writer.Bytes(), "net.onnx");
  EXPECT_THAT(graph.tensors[size_t(graph.inputs[0])].shape, ElementsAre(1, 3, 4, 4));
}

TEST(OnnxReader, NodesComeInAnyOrder) {
  Writer writer = Writer().Input("images", {1, 3, 4, 4});
  writer.Node("Tanh", {"b"}, {"y"}).Node("Add", {"a", "a"}, {"b"}).Node("Abs", {"images"}, {"c"});
  writer.Node("Cast", {"images"}, {"a"}).Output("y");
  const OperatorGraph graph = ParseOnnxGraph(writer.Bytes(), "net.onnx");
  std::vector<std::string> operators;
  std::vector<char> written(graph.tensors.size(), 0);
  written[size_t(graph.inputs[0])] = 1;
  for (const GraphNode& node : graph.nodes) {
    operators.push_back(node.op);
    for (const int input : node.inputs) EXPECT_TRUE(written[size_t(input)]) << node.op;
    for (const int output : node.outputs) written[size_t(output)] = 1;
  }
  // Of the nodes that can run the first in the file comes next.
  EXPECT_THAT(operators, ElementsAre("Abs", "Cast", "Add", "Tanh"));
}

TEST(OnnxReader, CirclesAreRefused) {
  EXPECT_THAT(RefusalOf(Passing().Node("Add", {"images", "b"}, {"a"}).Node("Relu", {"a"}, {"b"})),
              HasSubstr("node 1: nodes that take each other's results in a circle"));
  EXPECT_THAT(RefusalOf(Passing().Node("Relu", {"z"}, {"z"})), HasSubstr("node 1: nodes that take"));
}

TEST(OnnxReader, OtherFilesAreRefused) {
  const std::string tflite = TfliteWriter().Bytes();
  for (const std::string& bytes :
       {std::string(), std::string("text"), std::string(100, '\0'), std::string(100, '\xFF'), std::string("{\"a\": 1}"),
        std::string("PK\x03\x04"), std::string("\x89PNG\r\n\x1a\n"), tflite}) {
    EXPECT_THAT(FileErrorOf("other.onnx", [&] { ParseOnnxGraph(bytes, "other.onnx"); }), HasSubstr("not an ONNX file"));
  }
  FileErrorOf("/no/such.onnx", [] { ReadOnnxGraph("/no/such.onnx"); });
}

TEST(OnnxReader, WhatIsNotReadIsNamed) {
  EXPECT_THAT(RefusalOf(Passing().Input("second", {1})), HasSubstr("inputs: 2 of them, expected one image"));
  EXPECT_THAT(RefusalOf(Passing().Node("Relu", {"nowhere"}, {"z"})),
              HasSubstr("node '/Relu' (Relu): 'nowhere' is not there"));
  EXPECT_THAT(RefusalOf(Passing().Node("Relu", {"images"}, {"y"})), HasSubstr("'y' is written twice"));
  EXPECT_THAT(RefusalOf(Passing().Node("FusedConv", {"images"}, {"z"}, {}, "com.microsoft")),
              HasSubstr("node '/FusedConv' (FusedConv): an operator of its author's own"));
  EXPECT_THAT(RefusalOf(Passing().Node("If", {"images"}, {"z"}, {ProtoWriter().Bytes(1, "then").Bytes(6, "")})),
              HasSubstr("a graph within the graph"));
  EXPECT_THAT(RefusalOf(Passing().Output("nowhere")), HasSubstr("outputs: 'nowhere' is not there"));
  EXPECT_THAT(RefusalOf(Writer().Input("images", {1}).Node("Relu", {"images"}, {"y"})), HasSubstr("no outputs"));
  Writer old = Passing();
  old.opset = 6;
  EXPECT_THAT(RefusalOf(old), HasSubstr("version 6, expected 7 or later"));
  Writer other = Passing();
  other.graph.Message(5, Writer::Tensor<double>("d", static_cast<Writer::Type>(11), {1}, {1}));
  EXPECT_THAT(RefusalOf(other), HasSubstr("constant 'd': "));
  Writer outside = Passing();
  outside.graph.Message(5, ProtoWriter().Varint(1, 4).Varint(2, 1).Bytes(8, "far").Varint(14, 1));
  EXPECT_THAT(RefusalOf(outside), HasSubstr("constants: weights in another file"));
  Writer sparse = Passing();
  sparse.graph.Message(15, ProtoWriter());
  EXPECT_THAT(RefusalOf(sparse), HasSubstr("sparse constants"));
}

TEST(OnnxReader, SizesThatLieAreRefused) {
  const auto with = [](const std::vector<int64_t>& shape) {
    Writer writer = Passing();
    writer.graph.Message(5, Writer::Tensor<float>("w", Writer::kFloat, shape, {1, 2, 3}));
    return writer;
  };
  EXPECT_NO_THROW(ParseOnnxGraph(with({3, 1}).Bytes(), "net.onnx"));
  EXPECT_THAT(RefusalOf(with({4})), HasSubstr("12 bytes, expected 16 for a shape of 4"));
  EXPECT_THAT(RefusalOf(with({-3})), HasSubstr("a tensor of ?"));
  EXPECT_THAT(RefusalOf(with({1 << 20})), HasSubstr("much larger than the file"));
  EXPECT_THAT(RefusalOf(with({1 << 20, 1 << 20, 1 << 30})), HasSubstr("at most 2^27 numbers"));
  EXPECT_THAT(RefusalOf(with({1, 1, 1, 1, 1, 1, 1, 1, 3})), HasSubstr("9 axes"));
}

/// Reads copies of exactly as many bytes, so that a sanitizer sees every byte too many.
void ExpectReadOrRefused(const std::string& bytes, int* accepted) {
  const std::vector<char> exact(bytes.begin(), bytes.end());
  try {
    ParseOnnxGraph({exact.data(), exact.size()}, "cut.onnx");
    ++*accepted;
  } catch (const std::runtime_error& error) {
    ASSERT_EQ(std::string(error.what()).rfind("cut.onnx: ", 0), 0U) << error.what();
    ASSERT_TRUE(IsOneLine(error.what())) << error.what();
  }
}

TEST(OnnxReader, CutAnywhere) {
  for (const Writer& writer : SmallOnnxNetworks()) {
    const std::string bytes = writer.Bytes();
    int accepted = 0;
    for (size_t length = 0; length < bytes.size(); ++length) {
      ASSERT_NO_FATAL_FAILURE(ExpectReadOrRefused(bytes.substr(0, length), &accepted)) << length;
    }
    EXPECT_EQ(accepted, 0);
  }
}

TEST(OnnxReader, BytesChanged) {
  std::mt19937 random(4);
  int accepted = 0, tried = 0;
  for (const Writer& writer : SmallOnnxNetworks()) {
    const std::string bytes = writer.Bytes();
    for (int i = 0; i < 3000; ++i, ++tried) {
      std::string changed = bytes;
      for (unsigned n = 1 + random() % 3; n > 0; --n) changed[random() % bytes.size()] = static_cast<char>(random());
      ASSERT_NO_FATAL_FAILURE(ExpectReadOrRefused(changed, &accepted)) << i;
    }
  }
  EXPECT_GT(accepted, tried / 20);
  EXPECT_LT(accepted, tried * 19 / 20);
}

}  // namespace
}  // namespace bodyloom::onnx_reader_test
