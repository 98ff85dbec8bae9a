// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/tflite_reader.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "geometry/base/check.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/tracking/detection/inference/small_networks.h"
#include "tests/tracking/detection/inference/tflite_writer.h"

namespace bodyloom::tflite_refusals_test {
namespace {

using Writer = TfliteWriter;
using Storage = TfliteWriter::Storage;

struct Refusal {
  const char* expected;  ///< part of the message
  std::function<void(Writer*)> change;
};

void ExpectRefusals(const std::vector<Refusal>& refusals, const std::function<Writer()>& make) {
  for (const Refusal& refusal : refusals) {
    Writer writer = make();
    refusal.change(&writer);
    const std::string bytes = writer.Bytes();
    const std::string message = FileErrorOf("bad.tflite: ", [&] { ParseTfliteGraph(bytes, "bad.tflite"); });
    EXPECT_NE(message.find(refusal.expected), std::string::npos) << message << "\n  expected: " << refusal.expected;
    EXPECT_NE(message.find("expected"), std::string::npos) << message;
  }
}

/// The last operator's options, written anew.
void SetOptions(Writer* writer, const Writer::Options& options) {
  FlatNode node = FlatNode::Table();
  for (const auto& [field, value] : options) node.Set(field, value);
  writer->operators.back().Set(4, node);
}

TEST(TfliteReader, RefusesWhatItDoesNotRun) {
  const std::vector<int32_t> wrong_shape = {1, 4, 5, 3}, zero_side = {1, 0, 4, 3}, huge = {1, 100000, 100000, 3};
  const auto shape = [](Writer* w, size_t tensor, const std::vector<int32_t>& sides) {
    w->tensors[tensor].Set(0, FlatNode::Numbers(sides));
  };
  const auto inputs = [](Writer* w, const std::vector<int32_t>& operands) {
    w->operators[0].Set(1, FlatNode::Numbers(operands));
  };
  ExpectRefusals(
      {
          {"model: schema version 2, expected 3", [](Writer* w) { w->version = 2; }},
          {"model: 2 subgraphs, expected 1", [](Writer* w) { w->num_graphs = 2; }},
          {"model: 0 subgraphs, expected 1", [](Writer* w) { w->num_graphs = 0; }},
          {"operator 0: operator code 10, expected ADD", [](Writer* w) { w->codes[0] = FlatNode::Table().Set(0, 10); }},
          {"operator code 151, expected", [](Writer* w) { w->codes[0] = FlatNode::Table().Set(0, 127).Set(3, 151); }},
          {"operator code 32 'Own?Op', expected",
           [](Writer* w) { w->codes[0] = FlatNode::Table().Set(0, 32).Set(1, FlatNode::Text("Own\nOp")); }},
          {"operator 0: code 1, expected less than 1", [](Writer* w) { w->operators[0].Set(0, 1); }},
          {"operator 0 (CONV_2D): options of kind 2, expected 1", [](Writer* w) { w->operators[0].Set(3, 2); }},
          {"operator 0 (CONV_2D): 1 inputs, expected 2 to 3", [&](Writer* w) { inputs(w, {0}); }},
          {"4 inputs, expected 2 to 3",
           [&](Writer* w) {
             inputs(w, {0, 1, 2, 2});
           }},
          {"tensor -1, expected 0 to 3",
           [&](Writer* w) {
             inputs(w, {0, -1, 2});
           }},
          {"tensor 4, expected 0 to 3",
           [&](Writer* w) {
             inputs(w, {4, 1, 2});
           }},
          {"input 0 is tensor 1, expected one that was computed before",
           [&](Writer* w) {
             inputs(w, {1, 1, 2});
           }},
          {"input 0 is tensor 3, expected one that was computed before",
           [&](Writer* w) {
             inputs(w, {3, 1, 2});
           }},
          {"input 1 is tensor 0, expected a dense constant of float32",
           [&](Writer* w) {
             inputs(w, {0, 0, 2});
           }},
          {"a bias of shape 3x1x1x2, expected 3",
           [&](Writer* w) {
             inputs(w, {0, 1, 1});
           }},
          {"axes of the kernel: 1, expected 4",
           [&](Writer* w) {
             inputs(w, {0, 2, 2});
           }},
          {"writes tensor 0, which has its values already",
           [&](Writer* w) {
             shape(w, 0, {1, 4, 4, 3});
             shape(w, 1, {3, 1, 1, 2});
             w->operators[0].Set(2, FlatNode::Numbers(std::vector<int32_t>{3}));
             w->operators.push_back(w->operators[0]);
             w->inputs = {0, 0};
           }},
          {"0 outputs, expected 1",
           [](Writer* w) { w->operators[0].Set(2, FlatNode::Numbers(std::vector<int32_t>{})); }},
          {"padding 2, expected 0 (SAME) or 1 (VALID)",
           [](Writer* w) {
             SetOptions(w, {{0, 2}, {1, 1}, {2, 1}});
           }},
          {"strides 0 and 0, expected 1 to 3",
           [](Writer* w) {
             SetOptions(w, {{0, 0}});
           }},
          {"strides 4 and 1, expected 1 to 3",
           [](Writer* w) {
             SetOptions(w, {{1, 1}, {2, 4}});
           }},
          {"activation 1, expected 0 (none) or 3 (relu6)",
           [](Writer* w) {
             SetOptions(w, {{1, 1}, {2, 1}, {3, 1}});
           }},
          {"dilation 2, expected 1",
           [](Writer* w) {
             SetOptions(w, {{1, 1}, {2, 1}, {4, 2}});
           }},
          {"dilation 0, expected 1",
           [](Writer* w) {
             SetOptions(w, {{1, 1}, {2, 1}, {5, 0}});
           }},
          {"an output of shape 1x4x5x3, expected 1x4x4x3", [&](Writer* w) { shape(w, 3, wrong_shape); }},
          {"a kernel of shape 2x1x1x3, expected out x height x width x 2",
           [&](Writer* w) {
             shape(w, 1, {2, 1, 1, 3});
           }},
          {"24 bytes of values, expected 16",
           [&](Writer* w) {
             shape(w, 1, {2, 1, 1, 2});
           }},
          {"tensor 0 't0': axis 1 of size 0, expected 1 or more", [&](Writer* w) { shape(w, 0, zero_side); }},
          {"axis 2 of size 100000, expected 1 or more and at most 16777216", [&](Writer* w) { shape(w, 0, huge); }},
          {"5 axes, expected 1 to 4",
           [&](Writer* w) {
             shape(w, 0, {1, 1, 1, 1, 1});
           }},
          {"0 axes, expected 1 to 4", [&](Writer* w) { shape(w, 0, {}); }},
          {"axis 1 is dynamic",
           [](Writer* w) {
             w->tensors[0].Set(7, FlatNode::Numbers(std::vector<int32_t>{1, -1, 4, 2}));
           }},
          {"an input of shape 4x4x2, expected 1 x height x width x channels",
           [&](Writer* w) {
             shape(w, 0, {4, 4, 2});
           }},
          {"an input of shape 2x4x4x2, expected 1 x height",
           [&](Writer* w) {
             shape(w, 0, {2, 4, 4, 2});
           }},
          {"type 9, expected 0 (float32), 1 (float16) or 2 (int32)", [](Writer* w) { w->tensors[0].Set(1, 9); }},
          {"a variable", [](Writer* w) { w->tensors[0].Set(5, 1); }},
          {"buffer 9, expected less than 3", [](Writer* w) { w->tensors[0].Set(2, 9); }},
          {"among the inputs, expected float32", [](Writer* w) { w->tensors[0].Set(1, 1); }},
          {"writes tensor 3, expected one of float32", [](Writer* w) { w->tensors[3].Set(1, 1); }},
          {"an input of the network that is constant", [](Writer* w) { w->inputs = {1}; }},
          {"0 inputs, expected", [](Writer* w) { w->inputs = {}; }},
          {"0 outputs, expected", [](Writer* w) { w->outputs = {}; }},
          {"an output of the network that no operator writes", [](Writer* w) { w->outputs = {0}; }},
          {"an output of the network that no operator writes", [](Writer* w) { w->outputs = {1}; }},
          {"tensor 77, expected 0 to 3", [](Writer* w) { w->outputs = {77}; }},
      },
      [] { return OneConvolution(); });
}

TEST(TfliteReader, RefusesValuesThatAreNotFinite) {
  for (const float value : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    Writer writer = OneConvolution();
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof(value));
    bytes += std::string(20, '\0');
    writer.buffers[1] = FlatNode::Table().Set(0, FlatNode::Text(bytes));
    const std::string file = writer.Bytes();
    const std::string message = FileErrorOf("bad", [&] { ParseTfliteGraph(file, "bad"); });
    EXPECT_NE(message.find("tensor 1 't1': value 0 is"), std::string::npos) << message;
  }
}

/// A writer with the input as tensor 0, and an operator on it.
Writer On(const std::vector<int>& input, const std::function<int(Writer*)>& apply) {
  Writer writer;
  writer.Input(input);
  writer.outputs = {apply(&writer)};
  return writer;
}

TEST(TfliteReader, RefusesOperandsThatDoNotFit) {
  const std::vector<std::pair<const char*, Writer>> cases = {
      {"(ADD): 1x2x2x3 and 1x1x2x3, expected equal shapes",
       On({1, 2, 2, 3},
          [](Writer* w) {
            const int other = w->Conv(0, {3, 2, 1, 3}, {1, 1, 2, 3}, false, 1);
            return w->Apply(Writer::kAdd, {0, other}, {1, 2, 2, 3}, {{0, 0}});
          })},
      {"(CONCATENATION): axis 4, expected 0 to 3",
       On({1, 2, 2, 3},
          [](Writer* w) {
            return w->Apply(Writer::kConcatenation, {0, 0}, {1, 2, 2, 6}, {{0, 4}});
          })},
      {"input 1 of shape 1x2x2x1, expected 1x2x2x3 but for axis 1",
       On({1, 2, 2, 3},
          [](Writer* w) {
            const int other = w->Conv(0, {1, 1, 1, 3}, {1, 2, 2, 1}, false, 1);
            return w->Apply(Writer::kConcatenation, {0, other}, {1, 4, 2, 3}, {{0, 1}});
          })},
      {"(DEPTH_TO_SPACE): blocks of 2 of 6 channels",
       On({1, 2, 2, 6},
          [](Writer* w) {
            return w->Apply(Writer::kDepthToSpace, {0}, {1, 4, 4, 1}, {{0, 2}});
          })},
      {"blocks of 0 of 4 channels", On({1, 2, 2, 4},
                                       [](Writer* w) {
                                         return w->Apply(Writer::kDepthToSpace, {0}, {1, 2, 2, 4}, {{0, 0}});
                                       })},
      {"(MAX_POOL_2D): padding SAME that pads, expected VALID",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kMaxPool2d, {0}, {1, 2, 2, 1}, {{0, 0}, {1, 2}, {2, 2}, {3, 2}, {4, 2}});
          })},
      {"a window of 2x65, expected sides of 1 to 64",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kMaxPool2d, {0}, {1, 2, 2, 1}, {{0, 0}, {1, 2}, {2, 2}, {3, 65}, {4, 2}});
          })},
      {"a window of 4 on 3, expected one that fits", On({1, 3, 3, 1},
                                                        [](Writer* w) {
                                                          return w->Conv(0, {1, 4, 4, 1}, {1, 1, 1, 1}, false, 1);
                                                        })},
      {"channel multiplier 2, expected 1",
       On({1, 3, 3, 1},
          [](Writer* w) {
            const int kernel = w->Floats({1, 1, 1, 2}, {1, 2});
            return w->Apply(Writer::kDepthwiseConv2d, {0, kernel}, {1, 3, 3, 2}, {{1, 1}, {2, 1}, {3, 2}});
          })},
      {"(PAD): padding -1 of axis 2, expected 0 or more",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Pad(0, {0, 0, 0, 0, -1, 0, 0, 0}, {1, 3, 2, 1});
          })},
      {"padding 1 of axis 0, expected 0", On({1, 3, 3, 1},
                                             [](Writer* w) {
                                               return w->Pad(0, {0, 1, 0, 0, 0, 0, 0, 0}, {2, 3, 3, 1});
                                             })},
      {"paddings of shape 3x2, expected 4x2",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kPad, {0, w->Ints({3, 2}, {0, 0, 0, 0, 0, 0})}, {1, 3, 3, 1});
          })},
      {"a side of 2147483650", On({1, 3, 3, 1},
                                  [](Writer* w) {
                                    return w->Pad(0, {0, 0, 2147483647, 0, 0, 0, 0, 0}, {1, 3, 3, 1});
                                  })},
      {"(RESHAPE): to 5x-1, expected 9 numbers",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kReshape, {0, w->Ints({2}, {5, -1})}, {5, 2});
          })},
      {"to 3x-1x-1, expected 9 numbers",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kReshape, {0, w->Ints({3}, {3, -1, -1})}, {3, 3, 1});
          })},
      {"a side of 0, expected -1 or 1 to 9", On({1, 3, 3, 1},
                                                [](Writer* w) {
                                                  return w->Apply(Writer::kReshape, {0, w->Ints({2}, {0, 9})}, {1, 9});
                                                })},
      {"to 5 axes, expected 1 to 4", On({1, 3, 3, 1},
                                        [](Writer* w) {
                                          return w->Apply(Writer::kReshape, {0, w->Ints({5}, {1, 1, 1, 1, 9})}, {1, 9});
                                        })},
      {"input 1 is tensor 1, expected a dense constant of int32",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kReshape, {0, w->Floats({1}, {9})}, {9});
          })},
      {"(RESIZE_BILINEAR): align_corners 1, expected 0",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kResizeBilinear, {0, w->Ints({2}, {6, 6})}, {1, 6, 6, 1}, {{2, 1}, {3, 1}});
          })},
      {"half_pixel_centers 0, expected 1",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kResizeBilinear, {0, w->Ints({2}, {6, 6})}, {1, 6, 6, 1}, {{2, 0}});
          })},
      {"a size of 1 numbers, expected height and width",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kResizeBilinear, {0, w->Ints({1}, {6})}, {1, 6, 6, 1}, {{3, 1}});
          })},
      {"(DEQUANTIZE): of tensor 0, expected a dense float16 constant",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kDequantize, {0}, {1, 3, 3, 1});
          })},
      {"(FULLY_CONNECTED): an input of shape 1x3x3x1, expected rows x columns",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kFullyConnected, {0, w->Floats({2, 1}, {1, 2})}, {9, 2}, {{0, 0}});
          })},
      {"(FULLY_CONNECTED): weights of shape 2x4, expected out x 9",
       On({1, 9},
          [](Writer* w) {
            return w->Apply(Writer::kFullyConnected, {0, w->Floats({2, 4}, SomeFloats(8, 1))}, {1, 2}, {{0, 0}});
          })},
      {"(FULLY_CONNECTED): a bias of shape 3, expected 2",
       On({1, 2},
          [](Writer* w) {
            return w->Apply(Writer::kFullyConnected,
                            {0, w->Floats({2, 2}, SomeFloats(4, 1)), w->Floats({3}, {1, 2, 3})}, {1, 2}, {{0, 0}});
          })},
      {"(FULLY_CONNECTED): weights format 1, expected 0",
       On({1, 2},
          [](Writer* w) {
            return w->Apply(Writer::kFullyConnected, {0, w->Floats({2, 2}, SomeFloats(4, 1))}, {1, 2}, {{1, 1}});
          })},
      {"(MEAN): axis 4, expected different ones of 0 to 3",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kMean, {0, w->Ints({1}, {4})}, {1, 3, 3}, {{0, 0}});
          })},
      {"(MEAN): axis 2, expected different ones of 0 to 3",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kMean, {0, w->Ints({2}, {2, 2})}, {1, 3, 1}, {{0, 0}});
          })},
      {"(MEAN): over all axes, expected one that stays",
       On({1, 3},
          [](Writer* w) {
            return w->Apply(Writer::kMean, {0, w->Ints({2}, {0, 1})}, {1}, {{0, 0}});
          })},
      {"(PRELU): slopes of shape 1x1x2, expected 1x1x1",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kPrelu, {0, w->Floats({1, 1, 2}, {1, 2})}, {1, 3, 3, 1});
          })},
      {"(STRIDED_SLICE): 3 numbers for 4 axes, expected one for each",
       On({1, 3, 3, 1},
          [](Writer* w) {
            const int three = w->Ints({3}, {0, 0, 0}), four = w->Ints({4}, {1, 1, 1, 1});
            return w->Apply(Writer::kStridedSlice, {0, three, four, four}, {1, 1, 1, 1}, {{0, 0}});
          })},
      {"(STRIDED_SLICE): from 0 to 4 by 1 of axis 1, expected a range within 3 by 1",
       On({1, 3, 3, 1},
          [](Writer* w) {
            const int begin = w->Ints({4}, {0, 0, 0, 0}), end = w->Ints({4}, {1, 4, 3, 1}),
                      one = w->Ints({4}, {1, 1, 1, 1});
            return w->Apply(Writer::kStridedSlice, {0, begin, end, one}, {1, 4, 3, 1}, {{0, 0}});
          })},
      {"(STRIDED_SLICE): from 0 to 3 by 2 of axis 2, expected a range within 3 by 1",
       On({1, 3, 3, 1},
          [](Writer* w) {
            const int begin = w->Ints({4}, {0, 0, 0, 0}), end = w->Ints({4}, {1, 3, 3, 1}),
                      two = w->Ints({4}, {1, 1, 2, 1});
            return w->Apply(Writer::kStridedSlice, {0, begin, end, two}, {1, 3, 2, 1}, {{0, 0}});
          })},
      {"(STRIDED_SLICE): mask 1, expected 0",
       On({1, 3, 3, 1},
          [](Writer* w) {
            const int begin = w->Ints({4}, {0, 0, 0, 0}), end = w->Ints({4}, {1, 3, 3, 1}),
                      one = w->Ints({4}, {1, 1, 1, 1});
            return w->Apply(Writer::kStridedSlice, {0, begin, end, one}, {1, 3, 3, 1}, {{1, 1}});
          })},
      {"(DENSIFY): of tensor 1, expected a sparse constant",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kDensify, {w->Floats({2}, {1, 2})}, {2});
          })},
      {"(DEQUANTIZE): of tensor 1, expected a dense float16 constant",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kDequantize, {w->Sparse({2, 1, 1, 3}, SomeFloats(6, 1))}, {2, 1, 1, 3});
          })},
      {"(DENSIFY): into tensor 2 of shape 6, expected one of shape 2x1x1x3 and type 1",
       On({1, 3, 3, 1},
          [](Writer* w) {
            return w->Apply(Writer::kDensify, {w->Sparse({2, 1, 1, 3}, SomeFloats(6, 1))}, {6}, {}, 1);
          })},
  };
  for (const auto& [expected, writer] : cases) {
    const std::string bytes = writer.Bytes();
    const std::string message = FileErrorOf("bad.tflite: ", [&] { ParseTfliteGraph(bytes, "bad.tflite"); });
    EXPECT_NE(message.find(expected), std::string::npos) << message << "\n  expected: " << expected;
  }
}

/// A sparse kernel of shape 3×1×1×4 whose parts a test puts wrong.
struct SparseParts {
  std::vector<int32_t> starts = {0, 2, 2, 3}, order = {0, 1, 2, 3}, sizes = {3, 1, 1, 0}, formats = {0, 0, 0, 1},
                       blocks;
  std::vector<uint8_t> columns = {1, 3, 0};
  size_t values = 3;
  int kind = 3;
};

std::string SparseFile(const SparseParts& parts) {
  Writer writer;
  const int input = writer.Input({1, 2, 2, 4}), sparse = writer.Sparse({3, 1, 1, 4}, std::vector<float>(12, 1));
  std::string ones;
  for (size_t i = 0; i < parts.values; ++i) ones += std::string("\0\x3C", 2);
  writer.buffers[1] = FlatNode::Table().Set(0, FlatNode::Text(ones));
  std::vector<FlatNode> dimensions;
  for (size_t i = 0; i < parts.sizes.size(); ++i) {
    dimensions.push_back(FlatNode::Table().Set(0, parts.formats[i]).Set(1, parts.sizes[i]));
  }
  dimensions.back().Set(2, 1).Set(3, FlatNode::Table().Set(0, FlatNode::Numbers(parts.starts)));
  dimensions.back().Set(4, parts.kind).Set(5, FlatNode::Table().Set(0, FlatNode::Numbers(parts.columns)));
  writer.tensors[static_cast<size_t>(sparse)].Set(6, FlatNode::Table()
                                                         .Set(0, FlatNode::Numbers(parts.order))
                                                         .Set(1, FlatNode::Numbers(parts.blocks))
                                                         .Set(2, FlatNode::List(dimensions)));
  const int dense = writer.Apply(Writer::kDensify, {sparse}, {3, 1, 1, 4}, {}, 1);
  const int kernel = writer.Apply(Writer::kDequantize, {dense}, {3, 1, 1, 4});
  writer.outputs = {writer.Apply(Writer::kConv2d, {input, kernel}, {1, 2, 2, 3}, {{0, 0}, {1, 1}, {2, 1}})};
  return writer.Bytes();
}

TEST(TfliteReader, RefusesSparseConstantsThatLie) {
  EXPECT_EQ(ValuesOf(ParseTfliteGraph(SparseFile({}), "sparse").tensors[3]),
            (std::vector<float>{0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0}));
  const std::vector<std::pair<const char*, std::function<void(SparseParts*)>>> cases = {
      {"3 row starts for 3 rows",
       [](SparseParts* p) {
         p->starts = {0, 2, 3};
       }},
      {"4 row starts for 3 rows, expected one more, from 0",
       [](SparseParts* p) {
         p->starts = {1, 2, 2, 3};
       }},
      {"from 0 to the 3 columns",
       [](SparseParts* p) {
         p->starts = {0, 2, 2, 4};
       }},
      {"row 1 ends at value 1, expected 2 to 3",
       [](SparseParts* p) {
         p->starts = {0, 2, 1, 3};
       }},
      {"row 0 ends at value 9, expected 0 to 3",
       [](SparseParts* p) {
         p->starts = {0, 9, 9, 3};
       }},
      {"row 0 ends at value -1",
       [](SparseParts* p) {
         p->starts = {0, -1, 2, 3};
       }},
      {"column 4 in row 0, expected 2 to 3",
       [](SparseParts* p) {
         p->columns = {1, 4, 0};
       }},
      {"column 1 in row 0, expected 2 to 3",
       [](SparseParts* p) {
         p->columns = {1, 1, 0};
       }},
      {"4 bytes of values, expected 6", [](SparseParts* p) { p->values = 2; }},
      {"column numbers of kind 4", [](SparseParts* p) { p->kind = 4; }},
      {"whose axes are reordered",
       [](SparseParts* p) {
         p->order = {3, 1, 2, 0};
       }},
      {"whose axes are reordered",
       [](SparseParts* p) {
         p->order = {0, 1, 2, 3, 4};
       }},
      {"a sparse constant of blocks", [](SparseParts* p) { p->blocks = {0}; }},
      {"3 sparse axes, expected 4",
       [](SparseParts* p) {
         p->sizes = {3, 1, 1};
       }},
      {"sparse axis 0 of format 0 and size 7, expected 0 and 3", [](SparseParts* p) { p->sizes[0] = 7; }},
      {"sparse axis 1 of format 1", [](SparseParts* p) { p->formats[1] = 1; }},
      {"sparse axis 3 of format 0", [](SparseParts* p) { p->formats[3] = 0; }},
  };
  for (const auto& [expected, change] : cases) {
    SparseParts parts;
    change(&parts);
    const std::string bytes = SparseFile(parts);
    const std::string message = FileErrorOf("bad.tflite: ", [&] { ParseTfliteGraph(bytes, "bad.tflite"); });
    EXPECT_NE(message.find(expected), std::string::npos) << message << "\n  expected: " << expected;
  }
}

// A sparse constant names its size and stores next to nothing; a thousand tensors may point at one buffer.
TEST(TfliteReader, ConstantsAreBoundedByTheFile) {
  Writer sparse;
  const int input = sparse.Input({1, 1, 1, 1024});
  const int kernel = sparse.Floats({1024, 1, 1, 1024}, std::vector<float>(size_t{1024} * 1024, 0), Storage::kSparse);
  sparse.outputs = {sparse.Apply(Writer::kConv2d, {input, kernel}, {1, 1, 1, 1024}, {{0, 0}, {1, 1}, {2, 1}})};
  // A buffer without bytes would be no constant.
  sparse.buffers.push_back(FlatNode::Table().Set(0, FlatNode::Text("xx")));
  for (FlatNode& tensor : sparse.tensors) tensor.Set(2, static_cast<int32_t>(0));
  sparse.tensors[1].Set(2, static_cast<int32_t>(sparse.buffers.size()) - 1);
  std::string bytes = sparse.Bytes();
  std::string message = FileErrorOf("lies", [&] { ParseTfliteGraph(bytes, "lies"); });
  EXPECT_NE(message.find("constants of more than 16 times the file's bytes"), std::string::npos) << message;

  Writer shared;
  int last = shared.Input({1, 1, 1, 100});
  for (int i = 0; i < 40; ++i) {
    const int k = shared.Floats({100, 1, 1, 100}, std::vector<float>(10'000, 0.5F));
    shared.tensors[static_cast<size_t>(k)].Set(2, 1);
    shared.buffers.resize(2, FlatNode::Table());
    last = shared.Apply(Writer::kConv2d, {last, k}, {1, 1, 1, 100}, {{0, 0}, {1, 1}, {2, 1}});
  }
  shared.outputs = {last};
  bytes = shared.Bytes();
  EXPECT_LT(bytes.size(), 60'000U);
  message = FileErrorOf("lies", [&] { ParseTfliteGraph(bytes, "lies"); });
  EXPECT_NE(message.find("constants of more than 16 times the file's bytes"), std::string::npos) << message;
}

TEST(TfliteReader, WhatIsComputedIsBounded) {
  Writer writer;
  int last = writer.Input({1, 4096, 4096, 1});
  for (int i = 0; i < 16; ++i) last = writer.Apply(Writer::kLogistic, {last}, {1, 4096, 4096, 1});
  writer.outputs = {last};
  const std::string bytes = writer.Bytes();
  const std::string message = FileErrorOf("large", [&] { ParseTfliteGraph(bytes, "large"); });
  EXPECT_NE(message.find("more than 268435456 numbers to compute"), std::string::npos) << message;
}

}  // namespace
}  // namespace bodyloom::tflite_refusals_test
