// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/tflite_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "data_tools/formats/atomic_file.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/tracking/detection/inference/small_networks.h"
#include "tests/tracking/detection/inference/tflite_writer.h"

namespace bodyloom::tflite_reader_test {
namespace {

using Writer = TfliteWriter;
using Storage = TfliteWriter::Storage;
using Integers = std::vector<int64_t>;

TEST(TfliteReader, ReadsWhatTheFileSays) {
  const OperatorGraph model = ParseTfliteGraph(OneConvolution().Bytes(), "one.tflite");
  EXPECT_EQ(model.name, "one.tflite");
  EXPECT_EQ(model.inputs, std::vector<int>{0});
  EXPECT_EQ(model.outputs, std::vector<int>{3});
  ASSERT_EQ(model.tensors.size(), 5U) << "four of the file, and what is there before relu6";
  EXPECT_EQ(model.tensors[0].name, "t0");
  EXPECT_EQ(model.tensors[0].shape, (Integers{1, 4, 4, 2}));
  EXPECT_FALSE(model.tensors[0].constant.has_numbers());
  EXPECT_EQ(ValuesOf(model.tensors[1]), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(ValuesOf(model.tensors[2]), (std::vector<float>{7, 8, 9}));
  EXPECT_EQ(reinterpret_cast<uintptr_t>(model.tensors[1].constant.floats.data()) % 64, 0U);
  EXPECT_TRUE(model.channels_last);
  ASSERT_EQ(model.nodes.size(), 2U);
  const GraphNode &conv = model.nodes[0], &clip = model.nodes[1];
  EXPECT_EQ(conv.name, "operator 0 (CONV_2D)");
  EXPECT_EQ(conv.op, "Conv");
  EXPECT_EQ(conv.inputs, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(conv.Integers("pads", {}), (Integers{0, 0, 0, 0})) << "SAME with a kernel of one pixel";
  EXPECT_EQ(clip.op, "Clip");
  EXPECT_EQ(clip.inputs, conv.outputs);
  EXPECT_EQ(clip.outputs, std::vector<int>{3});
  EXPECT_EQ(clip.Float("min", -1), 0);
  EXPECT_EQ(clip.Float("max", -1), 6);
}

TEST(TfliteReader, OptionsByField) {
  Writer writer;
  const int input = writer.Input({1, 9, 9, 4});
  const int kernel = writer.Floats({1, 3, 2, 4}, SomeFloats(24, 1));
  const int depthwise = writer.Apply(Writer::kDepthwiseConv2d, {input, kernel}, {1, 7, 4, 4},
                                     {{0, 1}, {1, 2}, {2, 1}, {3, 1}, {4, 3}, {5, 1}, {6, 1}});
  const int pool =
      writer.Apply(Writer::kMaxPool2d, {depthwise}, {1, 3, 3, 4}, {{0, 1}, {1, 1}, {2, 2}, {3, 2}, {4, 3}});
  const int space = writer.Apply(Writer::kDepthToSpace, {pool}, {1, 6, 6, 1}, {{0, 2}});
  writer.outputs = {writer.Apply(Writer::kConcatenation, {space, space}, {1, 6, 6, 2}, {{0, -1}, {1, 3}})};
  const OperatorGraph model = ParseTfliteGraph(writer.Bytes(), "options.tflite");
  std::vector<std::string> ops;
  for (const GraphNode& node : model.nodes) ops.push_back(node.op);
  ASSERT_EQ(ops, (std::vector<std::string>{"Conv", "Clip", "MaxPool", "DepthToSpace", "Concat", "Clip"}));
  const GraphNode& d = model.nodes[0];
  EXPECT_FALSE(d.Has("pads"));
  EXPECT_EQ(d.Integers("strides", {}), (Integers{1, 2}));
  EXPECT_EQ(d.Integer("group", 1), 4);
  EXPECT_EQ(d.inputs.size(), 2U);
  const GraphNode& p = model.nodes[2];
  EXPECT_EQ(p.Integers("strides", {}), (Integers{2, 1}));
  EXPECT_EQ(p.Integers("kernel_shape", {}), (Integers{3, 2}));
  EXPECT_EQ(model.nodes[3].Integer("blocksize", 0), 2);
  EXPECT_EQ(model.nodes[4].Integer("axis", 0), 3);
}

TEST(TfliteReader, FoldsHalvesAndSparseConstants) {
  const std::vector<float> dense = SomeFloats(30, 3),
                           holes = {0, 1.5F, 0, 0, 0, 0, -2, 0.25F, 0, 3, 0, 0, 0, 0, 4, 5, 0, 6, 7, 0};
  for (const Storage storage : {Storage::kFloat16, Storage::kSparse}) {
    Writer writer;
    const int input = writer.Input({1, 2, 2, 5});
    const int first = writer.Floats({6, 1, 1, 5}, dense, storage), second = writer.Floats({2, 2, 1, 5}, holes, storage);
    const Writer::Options options = {{0, 0}, {1, 1}, {2, 1}};
    writer.outputs = {writer.Apply(Writer::kConv2d, {input, first, -1}, {1, 2, 2, 6}, options),
                      writer.Apply(Writer::kConv2d, {input, second}, {1, 2, 2, 2}, options)};
    const OperatorGraph model = ParseTfliteGraph(writer.Bytes(), "folded.tflite");
    ASSERT_EQ(model.nodes.size(), 2U) << "DEQUANTIZE and DENSIFY are no operators";
    EXPECT_EQ(model.nodes[0].inputs.size(), 2U) << "a bias that is left out is none";
    EXPECT_EQ(ValuesOf(model.tensors[static_cast<size_t>(first)]), dense);
    EXPECT_EQ(ValuesOf(model.tensors[static_cast<size_t>(second)]), holes);
  }
}

TEST(TfliteReader, ColumnNumbersOfEveryKind) {
  for (const int kind : {1, 2, 3}) {
    Writer writer;
    const std::vector<float> values = SomeFloats(12, 9);
    const int input = writer.Input({1, 2, 2, 4}), sparse = writer.Sparse({3, 1, 1, 4}, values, kind);
    const int dense = writer.Apply(Writer::kDensify, {sparse}, {3, 1, 1, 4}, {}, 1);
    const int kernel = writer.Apply(Writer::kDequantize, {dense}, {3, 1, 1, 4});
    writer.outputs = {writer.Apply(Writer::kConv2d, {input, kernel}, {1, 2, 2, 3}, {{0, 0}, {1, 1}, {2, 1}})};
    EXPECT_EQ(ValuesOf(ParseTfliteGraph(writer.Bytes(), "kinds").tensors[static_cast<size_t>(kernel)]), values) << kind;
  }
}

TEST(TfliteReader, CopiesShareConstants) {
  const OperatorGraph model = ParseTfliteGraph(OneConvolution().Bytes(), "one.tflite");
  const OperatorGraph copy = model;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(copy.tensors[1].constant.floats.data(), model.tensors[1].constant.floats.data());
}

TEST(TfliteReader, ReadsFromAFile) {
  const TemporaryFolder folder;
  const std::string path = folder.File("one.tflite");
  WriteFileAtomically(path, OneConvolution().Bytes());
  EXPECT_EQ(ReadTfliteGraph(path).nodes.size(), 2U);
  const std::string missing = folder.File("none.tflite");
  FileErrorOf(missing, [&] { ReadTfliteGraph(missing); });
}

}  // namespace
}  // namespace bodyloom::tflite_reader_test
