// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/tflite_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "data_tools/formats/atomic_file.h"
#include "tests/data_tools/detection/small_networks.h"
#include "tests/data_tools/detection/tflite_writer.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::tflite_model_test {
namespace {

using Writer = TfliteWriter;
using Storage = TfliteWriter::Storage;

TEST(TfliteModel, ReadsWhatTheFileSays) {
  const TfliteModel model = ParseTfliteModel(OneConvolution().Bytes(), "one.tflite");
  EXPECT_EQ(model.name, "one.tflite");
  EXPECT_EQ(model.inputs, std::vector<int>{0});
  EXPECT_EQ(model.outputs, std::vector<int>{3});
  ASSERT_EQ(model.tensors.size(), 4U);
  EXPECT_EQ(model.tensors[0].name, "t0");
  EXPECT_EQ(model.tensors[0].shape, (std::vector<int>{1, 4, 4, 2}));
  EXPECT_TRUE(model.tensors[0].values().empty());
  EXPECT_EQ(ValuesOf(model.tensors[1]), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(ValuesOf(model.tensors[2]), (std::vector<float>{7, 8, 9}));
  EXPECT_EQ(reinterpret_cast<uintptr_t>(model.tensors[1].floats.get()) % 64, 0U);
  ASSERT_EQ(model.operators.size(), 1U);
  const TfliteOperator& op = model.operators[0];
  EXPECT_EQ(op.kind, TfliteKind::kConv2d);
  EXPECT_STREQ(TfliteKindName(op.kind), "CONV_2D");
  EXPECT_EQ(op.inputs, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(op.output, 3);
  EXPECT_TRUE(op.relu6);
  EXPECT_TRUE(op.same_padding);
}

TEST(TfliteModel, OptionsByField) {
  Writer writer;
  const int input = writer.Input({1, 9, 9, 4});
  const int kernel = writer.Floats({1, 3, 2, 4}, SomeFloats(24, 1));
  const int depthwise = writer.Apply(Writer::kDepthwiseConv2d, {input, kernel}, {1, 7, 4, 4},
                                     {{0, 1}, {1, 2}, {2, 1}, {3, 1}, {4, 3}, {5, 1}, {6, 1}});
  const int pool =
      writer.Apply(Writer::kMaxPool2d, {depthwise}, {1, 3, 3, 4}, {{0, 1}, {1, 1}, {2, 2}, {3, 2}, {4, 3}});
  const int space = writer.Apply(Writer::kDepthToSpace, {pool}, {1, 6, 6, 1}, {{0, 2}});
  writer.outputs = {writer.Apply(Writer::kConcatenation, {space, space}, {1, 6, 6, 2}, {{0, -1}, {1, 3}})};
  const TfliteModel model = ParseTfliteModel(writer.Bytes(), "options.tflite");
  ASSERT_EQ(model.operators.size(), 4U);
  const TfliteOperator& d = model.operators[0];
  EXPECT_FALSE(d.same_padding);
  EXPECT_EQ(d.stride_w, 2);
  EXPECT_EQ(d.stride_h, 1);
  EXPECT_EQ(d.filter_h, 3);
  EXPECT_EQ(d.filter_w, 2);
  EXPECT_TRUE(d.relu6);
  EXPECT_EQ(d.inputs.size(), 2U);
  const TfliteOperator& p = model.operators[1];
  EXPECT_EQ(p.stride_w, 1);
  EXPECT_EQ(p.stride_h, 2);
  EXPECT_EQ(p.filter_w, 2);
  EXPECT_EQ(p.filter_h, 3);
  EXPECT_FALSE(p.relu6);
  EXPECT_EQ(model.operators[2].block_size, 2);
  EXPECT_EQ(model.operators[3].axis, 3);
  EXPECT_TRUE(model.operators[3].relu6);
}

TEST(TfliteModel, FoldsHalvesAndSparseConstants) {
  const std::vector<float> dense = SomeFloats(30, 3),
                           holes = {0, 1.5F, 0, 0, 0, 0, -2, 0.25F, 0, 3, 0, 0, 0, 0, 4, 5, 0, 6, 7, 0};
  for (const Storage storage : {Storage::kFloat16, Storage::kSparse}) {
    Writer writer;
    const int input = writer.Input({1, 2, 2, 5});
    const int first = writer.Floats({6, 1, 1, 5}, dense, storage), second = writer.Floats({2, 2, 1, 5}, holes, storage);
    const Writer::Options options = {{0, 0}, {1, 1}, {2, 1}};
    writer.outputs = {writer.Apply(Writer::kConv2d, {input, first, -1}, {1, 2, 2, 6}, options),
                      writer.Apply(Writer::kConv2d, {input, second}, {1, 2, 2, 2}, options)};
    const TfliteModel model = ParseTfliteModel(writer.Bytes(), "folded.tflite");
    ASSERT_EQ(model.operators.size(), 2U) << "DEQUANTIZE and DENSIFY are no operators";
    EXPECT_EQ(model.operators[0].inputs.size(), 2U) << "a bias that is left out is none";
    EXPECT_EQ(ValuesOf(model.tensors[static_cast<size_t>(first)]), dense);
    EXPECT_EQ(ValuesOf(model.tensors[static_cast<size_t>(second)]), holes);
  }
}

TEST(TfliteModel, ColumnNumbersOfEveryKind) {
  for (const int kind : {1, 2, 3}) {
    Writer writer;
    const std::vector<float> values = SomeFloats(12, 9);
    const int input = writer.Input({1, 2, 2, 4}), sparse = writer.Sparse({3, 1, 1, 4}, values, kind);
    const int dense = writer.Apply(Writer::kDensify, {sparse}, {3, 1, 1, 4}, {}, 1);
    const int kernel = writer.Apply(Writer::kDequantize, {dense}, {3, 1, 1, 4});
    writer.outputs = {writer.Apply(Writer::kConv2d, {input, kernel}, {1, 2, 2, 3}, {{0, 0}, {1, 1}, {2, 1}})};
    EXPECT_EQ(ValuesOf(ParseTfliteModel(writer.Bytes(), "kinds").tensors[static_cast<size_t>(kernel)]), values) << kind;
  }
}

TEST(TfliteModel, CopiesShareConstants) {
  const TfliteModel model = ParseTfliteModel(OneConvolution().Bytes(), "one.tflite");
  const TfliteModel copy = model;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(copy.tensors[1].floats.get(), model.tensors[1].floats.get());
}

TEST(TfliteModel, ReadsFromAFile) {
  const TemporaryFolder folder;
  const std::string path = folder.File("one.tflite");
  WriteFileAtomically(path, OneConvolution().Bytes());
  EXPECT_EQ(ReadTfliteModel(path).operators.size(), 1U);
  const std::string missing = folder.File("none.tflite");
  FileErrorOf(missing, [&] { ReadTfliteModel(missing); });
}

}  // namespace
}  // namespace bodyloom::tflite_model_test
