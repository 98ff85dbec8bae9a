// SPDX-License-Identifier: Apache-2.0
/// Each ONNX operator against values computed by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tracking/detection/inference/onednn_operator.h"
#include "tracking/detection/inference/operators.h"

namespace bodyloom::onnx_operators_test {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pointwise;
using ::testing::ThrowsMessage;

using Shape = std::vector<int64_t>;
using Floats = std::vector<float>;
using Ints = std::vector<int64_t>;

GraphTensor F(Shape shape, Floats values) { return {std::move(shape), std::move(values)}; }
GraphTensor I(Shape shape, Ints values) { return {std::move(shape), std::move(values)}; }

/// A node with its inputs; a tensor without numbers is left out.
struct Call {
  explicit Call(const std::string& op, std::vector<GraphTensor> its_inputs, int64_t its_opset = 17)
      : inputs(std::move(its_inputs)), opset(its_opset) {
    node.op = op;
    node.outputs = {0};
  }
  Call& With(const std::string& name, const Ints& values) {
    node.attributes[name].ints = values;
    return *this;
  }
  Call& WithFloat(const std::string& name, float value) {
    node.attributes[name].floats = {value};
    return *this;
  }
  Call& WithText(const std::string& name, const std::string& value) {
    node.attributes[name].text = value;
    return *this;
  }
  template <typename Function>
  auto operator()(const Function& function) const {
    std::vector<const GraphTensor*> pointers;
    for (const GraphTensor& input : inputs) pointers.push_back(input.has_numbers() ? &input : nullptr);
    FloatPool pool;
    const OperatorSettings settings = {opset, false, &pool};
    return function(OperatorArguments(node, settings, pointers));
  }

  GraphNode node;
  std::vector<GraphTensor> inputs;
  int64_t opset;
};

/// Of an operator on oneDNN whose inputs but the first are constants.
GraphTensor RunOnednnWith(const OperatorArguments& arguments, const FusedOperators& fused, const GraphTensor& image) {
  std::vector<bool> is_constant(arguments.num_inputs(), true);
  is_constant[0] = false;
  const auto made = OnednnOperator::Make(arguments, is_constant, fused).value();
  OnednnOperator::Memory memory;
  FloatPool pool;
  const std::vector<const GraphTensor*> inputs = {&image, arguments.Has(1) ? &arguments.Input(1) : nullptr};
  return made.Run(inputs, arguments.New<float>(GraphShapeSize(made.shape())), &memory, &pool);
}
GraphTensor RunOnednn(const OperatorArguments& arguments) { return RunOnednnWith(arguments, {}, arguments.Input(0)); }

void ExpectFloats(const GraphTensor& tensor, const Shape& shape, const Floats& values, float tolerance = 1e-6F) {
  EXPECT_EQ(tensor.shape, shape);
  ASSERT_TRUE(tensor.has_floats());
  EXPECT_THAT(tensor.floats, Pointwise(FloatNear(tolerance), values));
}

void ExpectInts(const GraphTensor& tensor, const Shape& shape, const Ints& values) {
  EXPECT_EQ(tensor.shape, shape);
  ASSERT_FALSE(tensor.has_floats());
  EXPECT_EQ(tensor.ints.Copy(), values);
}

template <typename Function>
void ExpectRefusal(const Call& call, const Function& function, const std::string& words) {
  EXPECT_THAT([&] { call(function); }, ThrowsMessage<std::runtime_error>(HasSubstr(words))) << call.node.op;
}

TEST(OnnxArithmetic, TwoTensorsBroadcast) {
  const GraphTensor rows = F({2, 1}, {10, 20}), columns = F({3}, {1, 2, 3}), number = F({}, {2});
  ExpectFloats(Call("Add", {rows, columns})(RunBinary), {2, 3}, {11, 12, 13, 21, 22, 23});
  ExpectFloats(Call("Sub", {columns, rows})(RunBinary), {2, 3}, {-9, -8, -7, -19, -18, -17});
  ExpectFloats(Call("Mul", {number, columns})(RunBinary), {3}, {2, 4, 6});
  ExpectFloats(Call("Div", {columns, number})(RunBinary), {3}, {0.5F, 1, 1.5F});
  ExpectFloats(Call("Pow", {columns, number})(RunBinary), {3}, {1, 4, 9});
  ExpectFloats(Call("Pow", {columns, I({}, {3})})(RunBinary), {3}, {1, 8, 27}, 1e-5F);
  ExpectFloats(Call("Max", {columns, number})(RunBinary), {3}, {2, 2, 3});
  ExpectFloats(Call("Min", {columns, number})(RunBinary), {3}, {1, 2, 2});
  ExpectFloats(Call("Add", {F({1, 2, 1, 2}, {1, 2, 3, 4}), F({2, 1}, {10, 20})})(RunBinary), {1, 2, 2, 2},
               {11, 12, 21, 22, 13, 14, 23, 24});
  ExpectInts(Call("Equal", {columns, number})(RunBinary), {3}, {0, 1, 0});
  ExpectInts(Call("Div", {I({2}, {7, -7}), I({}, {2})})(RunBinary), {2}, {3, -3});
  ExpectInts(Call("Mul", {I({2}, {7, -7}), I({}, {2})})(RunBinary), {2}, {14, -14});
  ExpectFloats(Call("Where", {I({2}, {1, 0}), F({}, {5}), F({2}, {6, 7})})(RunWhere), {2}, {5, 7});
  ExpectInts(Call("Where", {I({2}, {1, 0}), I({}, {5}), I({2}, {6, 7})})(RunWhere), {2}, {5, 7});
}

TEST(OnnxArithmetic, TwoTensorsThatDoNotFit) {
  ExpectRefusal(Call("Add", {F({2}, {1, 2}), F({3}, {1, 2, 3})}), RunBinary, "2 and 3 do not fit");
  ExpectRefusal(Call("Add", {F({1}, {1}), I({1}, {1})}), RunBinary, "one kind");
  ExpectRefusal(Call("Add", {F({1}, {1}), {}}), RunBinary, "input 1 is missing");
  ExpectRefusal(Call("Div", {I({1}, {1}), I({1}, {0})}), RunBinary, "division by zero");
  const int64_t minimum = std::numeric_limits<int64_t>::min();
  ExpectInts(Call("Div", {I({1}, {minimum}), I({1}, {-1})})(RunBinary), {1}, {minimum});
}

TEST(OnnxArithmetic, NumberByNumber) {
  const GraphTensor x = F({4}, {-2, -0.5F, 0, 4});
  ExpectFloats(Call("Sigmoid", {x})(RunOnednn), {4}, {0.11920292F, 0.37754067F, 0.5F, 0.98201379F});
  ExpectFloats(Call("HardSigmoid", {x})(RunUnary), {4}, {0.1F, 0.4F, 0.5F, 1});
  ExpectFloats(Call("HardSigmoid", {x}).WithFloat("alpha", 1.0F / 6)(RunUnary), {4}, {1.0F / 6, 0.41666667F, 0.5F, 1});
  ExpectFloats(Call("HardSwish", {x})(RunUnary), {4}, {-1.0F / 3, -0.20833333F, 0, 4});
  ExpectFloats(Call("Relu", {x})(RunUnary), {4}, {0, 0, 0, 4});
  ExpectFloats(Call("LeakyRelu", {x}).WithFloat("alpha", 0.5F)(RunUnary), {4}, {-1, -0.25F, 0, 4});
  ExpectFloats(Call("Tanh", {x})(RunUnary), {4}, {-0.96402758F, -0.46211716F, 0, 0.9993293F});
  ExpectFloats(Call("Exp", {x})(RunUnary), {4}, {0.13533528F, 0.60653066F, 1, 54.59815F}, 1e-4F);
  ExpectFloats(Call("Abs", {x})(RunUnary), {4}, {2, 0.5F, 0, 4});
  ExpectFloats(Call("Neg", {x})(RunUnary), {4}, {2, 0.5F, 0, -4});
  ExpectFloats(Call("Floor", {x})(RunUnary), {4}, {-2, -1, 0, 4});
  ExpectFloats(Call("Sqrt", {F({2}, {0, 9})})(RunUnary), {2}, {0, 3});
  ExpectFloats(Call("Clip", {x, F({}, {-1}), F({}, {1})})(RunUnary), {4}, {-1, -0.5F, 0, 1});
  ExpectFloats(Call("Clip", {x, F({}, {-1})})(RunUnary), {4}, {-1, -0.5F, 0, 4});
  ExpectFloats(Call("Clip", {x, {}, F({}, {1})})(RunUnary), {4}, {-2, -0.5F, 0, 1});
  ExpectFloats(Call("Clip", {x}, 6).WithFloat("min", 0).WithFloat("max", 3)(RunUnary), {4}, {0, 0, 0, 3});
  ExpectInts(Call("Neg", {I({1}, {3})})(RunUnary), {1}, {-3});
  ExpectRefusal(Call("Relu", {I({1}, {3})}), RunUnary, "whole numbers, expected floats");
}

TEST(OnnxArithmetic, SumsOverAxes) {
  const GraphTensor x = F({2, 3}, {1, 2, 3, 4, 5, 6});
  ExpectFloats(Call("ReduceSum", {x, I({1}, {1})})(RunReduce), {2, 1}, {6, 15});
  ExpectFloats(Call("ReduceSum", {x}, 11).With("axes", {-2})(RunReduce), {1, 3}, {5, 7, 9});
  ExpectFloats(Call("ReduceMean", {x}).With("axes", {1}).With("keepdims", {0})(RunReduce), {2}, {2, 5});
  ExpectFloats(Call("ReduceMax", {x}).With("axes", {0})(RunReduce), {1, 3}, {4, 5, 6});
  ExpectFloats(Call("ReduceL2", {F({1, 2}, {3, 4})}).With("axes", {1})(RunReduce), {1, 1}, {5});
  ExpectFloats(Call("ReduceSum", {x}).With("keepdims", {0})(RunReduce), {}, {21});
  ExpectRefusal(Call("ReduceSum", {x, I({1}, {2})}), RunReduce, "axis 2 of 2");
}

TEST(OnnxArithmetic, SoftmaxAlongAnyAxis) {
  const float a = 1 / (1 + std::exp(1.0F)), b = 1 - a;
  ExpectFloats(Call("Softmax", {F({2, 2}, {0, 1, 100, 101})})(RunSoftmax), {2, 2}, {a, b, a, b});
  ExpectFloats(Call("Softmax", {F({2, 2}, {0, 100, 1, 101})}).With("axis", {0})(RunSoftmax), {2, 2}, {a, a, b, b});
  ExpectFloats(Call("Softmax", {F({1, 2}, {0, 1})}, 11)(RunSoftmax), {1, 2}, {a, b});
  ExpectRefusal(Call("Softmax", {F({1, 2, 2}, {0, 1, 2, 3})}, 11).With("axis", {1}), RunSoftmax, "several axes");
}

TEST(OnnxRearrangement, ConcatenatesAndSplits) {
  const GraphTensor x = F({2, 3}, {1, 2, 3, 4, 5, 6});
  ExpectFloats(Call("Concat", {x, F({2, 1}, {7, 8})}).With("axis", {-1})(RunConcat), {2, 4}, {1, 2, 3, 7, 4, 5, 6, 8});
  ExpectFloats(Call("Concat", {x, F({1, 3}, {7, 8, 9})}).With("axis", {0})(RunConcat), {3, 3},
               {1, 2, 3, 4, 5, 6, 7, 8, 9});
  ExpectInts(Call("Concat", {I({1}, {1}), I({2}, {2, 3})}).With("axis", {0})(RunConcat), {3}, {1, 2, 3});
  ExpectRefusal(Call("Concat", {x, F({1, 3}, {7, 8, 9})}).With("axis", {1}), RunConcat, "1x3 beside 2x3");
  ExpectRefusal(Call("Concat", {x, F({3}, {7, 8, 9})}).With("axis", {0}), RunConcat, "different ranks");

  const std::vector<GraphTensor> parts = Call("Split", {x, I({2}, {1, 2})}).With("axis", {1})(RunSplit);
  ASSERT_EQ(parts.size(), 2U);
  ExpectFloats(parts[0], {2, 1}, {1, 4});
  ExpectFloats(parts[1], {2, 2}, {2, 3, 5, 6});
  EXPECT_EQ(Call("Split", {x}, 11).With("axis", {1}).With("split", {2, 1})(RunSplit)[1].shape, Shape({2, 1}));
  Call halves("Split", {x});
  halves.node.outputs = {0, 1};
  ExpectFloats(halves(RunSplit)[1], {1, 3}, {4, 5, 6});
  ExpectRefusal(Call("Split", {x, I({2}, {1, 3})}).With("axis", {1}), RunSplit, "do not fit");
  ExpectRefusal(Call("Split", {x, I({1}, {2})}).With("axis", {1}), RunSplit, "parts of 2 for an axis of 3");
  ExpectRefusal(Call("Split", {x, I({2}, {-1, 4})}).With("axis", {1}), RunSplit, "do not fit");
}

TEST(OnnxRearrangement, Slices) {
  const GraphTensor x = F({5}, {0, 1, 2, 3, 4});
  const auto slice = [&x](int64_t begin, int64_t end, int64_t step) {
    return Call("Slice", {x, I({1}, {begin}), I({1}, {end}), I({1}, {0}), I({1}, {step})})(RunSlice).floats.Copy();
  };
  constexpr int64_t kEnd = std::numeric_limits<int64_t>::max(), kBegin = std::numeric_limits<int64_t>::min();
  EXPECT_THAT(slice(1, 3, 1), ElementsAre(1, 2));
  EXPECT_THAT(slice(-2, kEnd, 1), ElementsAre(3, 4));
  EXPECT_THAT(slice(0, kEnd, 2), ElementsAre(0, 2, 4));
  EXPECT_THAT(slice(1, 5, 2), ElementsAre(1, 3));
  EXPECT_THAT(slice(-1, kBegin, -1), ElementsAre(4, 3, 2, 1, 0));
  EXPECT_THAT(slice(9, kBegin, -2), ElementsAre(4, 2, 0));
  EXPECT_THAT(slice(3, 0, -2), ElementsAre(3, 1));
  EXPECT_THAT(slice(4, 2, 1), IsEmpty());
  EXPECT_THAT(slice(kBegin, kEnd, 1), ElementsAre(0, 1, 2, 3, 4));
  const GraphTensor matrix = F({2, 3}, {1, 2, 3, 4, 5, 6});
  ExpectFloats(Call("Slice", {matrix, I({2}, {0, 1}), I({2}, {1, 3})})(RunSlice), {1, 2}, {2, 3});
  ExpectFloats(Call("Slice", {matrix}, 9).With("starts", {1}).With("ends", {3}).With("axes", {1})(RunSlice), {2, 2},
               {2, 3, 5, 6});
  ExpectFloats(Call("Slice", {matrix, I({1}, {2}), I({1}, {-4}), I({1}, {-1}), I({1}, {-2})})(RunSlice), {2, 2},
               {3, 1, 6, 4});
  ExpectRefusal(Call("Slice", {x, I({1}, {0}), I({1}, {1}), I({1}, {0}), I({1}, {0})}), RunSlice, "in steps of 0");
  ExpectRefusal(Call("Slice", {x, I({1}, {0}), I({2}, {1, 2})}), RunSlice, "different numbers");
}

TEST(OnnxRearrangement, TransposesAndGathers) {
  const GraphTensor x = F({1, 2, 3}, {1, 2, 3, 4, 5, 6});
  ExpectFloats(Call("Transpose", {x})(RunTranspose), {3, 2, 1}, {1, 4, 2, 5, 3, 6});
  ExpectFloats(Call("Transpose", {x}).With("perm", {1, 0, 2})(RunTranspose), {2, 1, 3}, {1, 2, 3, 4, 5, 6});
  ExpectFloats(Call("Transpose", {x}).With("perm", {2, 0, 1})(RunTranspose), {3, 1, 2}, {1, 4, 2, 5, 3, 6});
  ExpectRefusal(Call("Transpose", {x}).With("perm", {0, 1, 1}), RunTranspose, "none of the axes");
  ExpectRefusal(Call("Transpose", {x}).With("perm", {0, 1}), RunTranspose, "none of the axes");
  ExpectFloats(Call("Gather", {x, I({2}, {2, -3})}).With("axis", {2})(RunGather), {1, 2, 2}, {3, 1, 6, 4});
  ExpectFloats(Call("Gather", {x, I({}, {1})}).With("axis", {1})(RunGather), {1, 3}, {4, 5, 6});
  ExpectRefusal(Call("Gather", {x, I({}, {2})}).With("axis", {1}), RunGather, "entry 2 of an axis of 2");
  const GraphTensor zeros = F({2, 3}, Floats(6, 0));
  ExpectFloats(Call("ScatterND", {zeros, I({1, 1}, {1}), F({1, 3}, {1, 2, 3})})(RunScatterNd), {2, 3},
               {0, 0, 0, 1, 2, 3});
  ExpectFloats(Call("ScatterND", {zeros, I({2, 2}, {0, 0, 1, -1}), F({2}, {8, 9})})(RunScatterNd), {2, 3},
               {8, 0, 0, 0, 0, 9});
  ExpectRefusal(Call("ScatterND", {zeros, I({1, 1}, {2}), F({1, 3}, {1, 2, 3})}), RunScatterNd, "entry 2");
  ExpectRefusal(Call("ScatterND", {zeros, I({1, 1}, {1}), F({2}, {1, 2})}), RunScatterNd, "2 values, expected 3");
}

TEST(OnnxRearrangement, Reshapes) {
  const GraphTensor x = F({1, 2, 3}, {1, 2, 3, 4, 5, 6});
  const auto shape = [&x](const Ints& wanted) {
    return Call("Reshape", {x, I({int64_t(wanted.size())}, wanted)})(RunReshape).shape;
  };
  EXPECT_EQ(shape({3, 2}), Shape({3, 2}));
  EXPECT_EQ(shape({-1, 2}), Shape({3, 2}));
  EXPECT_EQ(shape({0, 0, -1, 1}), Shape({1, 2, 3, 1}));
  ExpectRefusal(Call("Reshape", {x, I({2}, {-1, 4})}), RunReshape, "1x2x3 cannot become ?x4");
  ExpectRefusal(Call("Reshape", {x, I({2}, {-1, -1})}), RunReshape, "two axes open");
  ExpectRefusal(Call("Reshape", {x, I({1}, {7})}), RunReshape, "cannot become 7");
  EXPECT_EQ(Call("Flatten", {x}).With("axis", {2})(RunReshape).shape, Shape({2, 3}));
  EXPECT_EQ(Call("Flatten", {x})(RunReshape).shape, Shape({1, 6}));
  EXPECT_EQ(Call("Squeeze", {x})(RunReshape).shape, Shape({2, 3}));
  EXPECT_EQ(Call("Squeeze", {x, I({1}, {0})})(RunReshape).shape, Shape({2, 3}));
  ExpectRefusal(Call("Squeeze", {x, I({1}, {1})}), RunReshape, "is no 1");
  EXPECT_EQ(Call("Unsqueeze", {x}, 11).With("axes", {0, -1})(RunReshape).shape, Shape({1, 1, 2, 3, 1}));
  ExpectRefusal(Call("Unsqueeze", {x, I({2}, {0, 0})}), RunReshape, "named twice");
}

TEST(OnnxRearrangement, RepeatsCastsAndCounts) {
  ExpectFloats(Call("Expand", {F({2, 1}, {1, 2}), I({3}, {2, 1, 2})})(RunExpand), {2, 2, 2}, {1, 1, 2, 2, 1, 1, 2, 2});
  ExpectFloats(Call("Expand", {F({3}, {1, 2, 3}), I({1}, {1})})(RunExpand), {3}, {1, 2, 3});
  ExpectFloats(Call("Tile", {F({2}, {1, 2}), I({1}, {2})})(RunTile), {4}, {1, 2, 1, 2});
  ExpectFloats(Call("Tile", {F({1, 2}, {1, 2}), I({2}, {2, 1})})(RunTile), {2, 2}, {1, 2, 1, 2});
  ExpectInts(Call("Cast", {F({3}, {1.9F, -1.9F, 0})}).With("to", {7})(RunCast), {3}, {1, -1, 0});
  ExpectInts(Call("Cast", {F({2}, {0.5F, 0})}).With("to", {9})(RunCast), {2}, {1, 0});
  ExpectFloats(Call("Cast", {I({2}, {3, -4})}).With("to", {1})(RunCast), {2}, {3, -4});
  ExpectFloats(Call("Cast", {F({1}, {0.5F})}).With("to", {10})(RunCast), {1}, {0.5F});
  ExpectRefusal(Call("Cast", {F({1}, {1e30F})}).With("to", {7}), RunCast, "too large");
  ExpectRefusal(Call("Cast", {F({1}, {1})}).With("to", {8}), RunCast, "type 8");
  ExpectInts(Call("Shape", {F({2, 3, 1}, Floats(6, 0))})(RunShapeOf), {3}, {2, 3, 1});
  ExpectInts(Call("Shape", {F({2, 3, 1}, Floats(6, 0))}).With("start", {1}).With("end", {-1})(RunShapeOf), {1}, {3});
  ExpectFloats(Call("Constant", {}).WithFloat("value_float", 2)(RunConstant), {}, {2});
  ExpectInts(Call("Constant", {}).With("value_ints", {2, 3})(RunConstant), {2}, {2, 3});
  ExpectRefusal(Call("Constant", {}), RunConstant, "without numbers");
  ExpectFloats(Call("ConstantOfShape", {I({2}, {1, 2})})(RunConstantOfShape), {1, 2}, {0, 0});
  ExpectRefusal(Call("ConstantOfShape", {I({2}, {1 << 20, 1 << 20})}), RunConstantOfShape, "2^27");
  ExpectFloats(Call("Range", {F({}, {0.5F}), F({}, {3}), F({}, {1})})(RunRange), {3}, {0.5F, 1.5F, 2.5F});
  ExpectInts(Call("Range", {I({}, {5}), I({}, {0}), I({}, {-2})})(RunRange), {3}, {5, 3, 1});
  ExpectRefusal(Call("Range", {I({}, {5}), I({}, {9}), I({}, {0})}), RunRange, "without an end");
}

TEST(OnnxImage, MaxPoolTakesTheLargestOfEachWindow) {
  const GraphTensor image = F({1, 1, 3, 4}, {1, 2, 3, 4, 8, 7, 6, 5, -1, -2, -3, -4});
  const Call same = Call("MaxPool", {image}).With("kernel_shape", {3, 3}).With("pads", {1, 1, 1, 1});
  ExpectFloats(same(RunOnednn), {1, 1, 3, 4}, {8, 8, 7, 6, 8, 8, 7, 6, 8, 8, 7, 6});
  const Call halves = Call("MaxPool", {image}).With("kernel_shape", {2, 2}).With("strides", {2, 2});
  ExpectFloats(halves(RunOnednn), {1, 1, 1, 2}, {8, 6});
  Call ceil = halves;
  ExpectFloats(ceil.With("ceil_mode", {1})(RunOnednn), {1, 1, 2, 2}, {8, 6, -1, -3});
  Call automatic = halves;
  ExpectFloats(automatic.WithText("auto_pad", "SAME_UPPER")(RunOnednn), {1, 1, 2, 2}, {8, 6, -1, -3});
  ExpectRefusal(Call("MaxPool", {image}).With("kernel_shape", {5, 1}), RunOnednn, "a window of 5 on an image of 3");
  ExpectRefusal(Call("MaxPool", {image}).With("kernel_shape", {2}), RunOnednn, "a window of 2");
  ExpectRefusal(Call("MaxPool", {image}).With("kernel_shape", {2, 2}).With("pads", {2, 0, 0, 0}), RunOnednn,
                "padding of 2 and 0");
  ExpectRefusal(Call("MaxPool", {F({3}, {1, 2, 3})}).With("kernel_shape", {1, 1}), RunOnednn, "an input of 3");
}

TEST(OnnxImage, MeansSizesAndNormalisation) {
  const GraphTensor image = F({1, 2, 1, 2}, {1, 3, 10, 20});
  ExpectFloats(Call("GlobalAveragePool", {image})(RunGlobalAveragePool), {1, 2, 1, 1}, {2, 15});
  const Floats doubled = {1, 1, 3, 3, 1, 1, 3, 3, 10, 10, 20, 20, 10, 10, 20, 20};
  const GraphTensor scales = F({4}, {1, 1, 2, 2});
  ExpectFloats(Call("Resize", {image, {}, scales})(RunOnednn), {1, 2, 2, 4}, doubled);
  ExpectFloats(Call("Resize", {image, {}, {}, I({4}, {1, 2, 2, 4})})(RunOnednn), {1, 2, 2, 4}, doubled);
  ExpectFloats(Call("Upsample", {image, scales}, 9)(RunOnednn), {1, 2, 2, 4}, doubled);
  ExpectRefusal(Call("Resize", {image, {}, F({4}, {1, 1, 1.5F, 2})}), RunOnednn, "whole multiple");
  ExpectRefusal(Call("Resize", {image, {}, F({4}, {1, 2, 1, 1})}), RunOnednn, "whole multiple");
  ExpectRefusal(Call("Resize", {image, {}, scales}).WithText("mode", "linear"), RunOnednn, "nearest");
  const Call norm("BatchNormalization", {image, F({2}, {2, 1}), F({2}, {0.5F, 0}), F({2}, {1, 10}), F({2}, {4, 25})});
  ExpectFloats(Call(norm).WithFloat("epsilon", 0)(RunBatchNormalization), {1, 2, 1, 2}, {0.5F, 2.5F, 0, 2});
}

TEST(OnnxProducts, OfMatrices) {
  const GraphTensor a = F({2, 3}, {1, 2, 3, 4, 5, 6}), b = F({3, 2}, {1, 0, 0, 1, 1, 1});
  ExpectFloats(Call("MatMul", {a, b})(RunMatMul), {2, 2}, {4, 5, 10, 11});
  ExpectFloats(Call("MatMul", {F({3}, {1, 2, 3}), b})(RunMatMul), {2}, {4, 5});
  ExpectFloats(Call("MatMul", {a, F({3}, {1, 1, 0})})(RunMatMul), {2}, {3, 9});
  // Two products with one matrix, and two with two.
  ExpectFloats(Call("MatMul", {F({2, 1, 3}, {1, 2, 3, 4, 5, 6}), b})(RunMatMul), {2, 1, 2}, {4, 5, 10, 11});
  ExpectFloats(Call("MatMul", {F({2, 1, 2}, {1, 2, 3, 4}), F({2, 2, 1}, {1, 1, 2, 2})})(RunMatMul), {2, 1, 1}, {3, 14});
  ExpectFloats(Call("MatMul", {F({1, 2}, {1, 2}), F({2, 2, 1}, {1, 1, 2, 2})})(RunMatMul), {2, 1, 1}, {3, 6});
  ExpectRefusal(Call("MatMul", {a, a}), RunMatMul, "a product of 2x3 and 2x3");
  const Call gemm("Gemm", {b, F({2, 3}, {1, 0, 0, 0, 1, 0}), F({3}, {1, 2, 3})});
  ExpectFloats(gemm(RunGemm), {3, 3}, {2, 2, 3, 1, 3, 3, 2, 3, 3});
  ExpectFloats(Call("Gemm", {a, F({2, 3}, {1, 1, 1, 0, 0, 1})}).With("transB", {1}).WithFloat("alpha", 2)(RunGemm),
               {2, 2}, {12, 6, 30, 12});
  ExpectFloats(Call("Gemm", {b, F({3, 1}, {1, 2, 3})}).With("transA", {1})(RunGemm), {2, 1}, {4, 5});
}

/// A convolution, number by number.
Floats Convolved(const GraphTensor& image, const GraphTensor& kernel, const Floats& bias, int64_t groups,
                 int64_t stride, int64_t dilation, int64_t pad, Shape* shape) {
  const int64_t height = image.shape[2], width = image.shape[3], k = kernel.shape[2], per = kernel.shape[1];
  const auto count = [&](int64_t n) { return (n + 2 * pad - dilation * (k - 1) - 1) / stride + 1; };
  *shape = {1, kernel.shape[0], count(height), count(width)};
  Floats result;
  for (int64_t o = 0; o < (*shape)[1]; ++o) {
    for (int64_t y = 0; y < (*shape)[2]; ++y) {
      for (int64_t x = 0; x < (*shape)[3]; ++x) {
        double sum = bias.empty() ? 0 : bias[size_t(o)];
        for (int64_t c = 0; c < per; ++c) {
          const int64_t plane = o / ((*shape)[1] / groups) * per + c;
          for (int64_t i = 0; i < k; ++i) {
            for (int64_t j = 0; j < k; ++j) {
              const int64_t row = y * stride - pad + i * dilation, column = x * stride - pad + j * dilation;
              if (row < 0 || column < 0 || row >= height || column >= width) continue;
              sum += double(kernel.floats[size_t(((o * per + c) * k + i) * k + j)]) *
                     double(image.floats[size_t((plane * height + row) * width + column)]);
            }
          }
        }
        result.push_back(float(sum));
      }
    }
  }
  return result;
}

Floats SomeNumbers(size_t count, uint32_t seed) {
  Floats values(count);
  for (float& value : values) {
    seed = seed * 1664525U + 1013904223U;
    value = float(int(seed >> 24) - 128) / 64;
  }
  return values;
}

TEST(OnnxConvolution, AgreesWithLoops) {
  struct Case {
    int64_t channels, out, kernel, groups, stride, dilation, pad;
    bool bias, swish;
  };
  for (const Case& c : {Case{3, 16, 3, 1, 2, 1, 1, true, true}, Case{8, 8, 5, 8, 1, 1, 2, false, false},
                        Case{6, 4, 3, 2, 1, 1, 0, true, false}, Case{16, 32, 1, 1, 1, 1, 0, true, true},
                        Case{4, 4, 3, 1, 1, 2, 2, true, false}, Case{5, 7, 7, 1, 1, 1, 3, false, true}}) {
    const GraphTensor image = F({1, c.channels, 9, 11}, SomeNumbers(size_t(c.channels * 99), 1));
    const GraphTensor kernel = F({c.out, c.channels / c.groups, c.kernel, c.kernel},
                                 SomeNumbers(size_t(c.out * c.channels / c.groups * c.kernel * c.kernel), 2));
    const Floats bias = c.bias ? SomeNumbers(size_t(c.out), 3) : Floats();
    std::vector<GraphTensor> inputs = {image, kernel};
    if (c.bias) inputs.push_back(F({c.out}, bias));
    Call call("Conv", inputs);
    call.With("group", {c.groups}).With("strides", {c.stride, c.stride}).With("dilations", {c.dilation, c.dilation});
    call.With("pads", {c.pad, c.pad, c.pad, c.pad});
    Shape shape;
    Floats expected = Convolved(image, kernel, bias, c.groups, c.stride, c.dilation, c.pad, &shape);
    if (c.swish) {
      for (float& value : expected) value /= 1 + std::exp(-value);
    }
    const GraphTensor result = call([&](const OperatorArguments& a) {
      return RunOnednnWith(a, {.sum = false, .swish = c.swish, .clip = {}}, image);
    });
    ExpectFloats(result, shape, expected, 1e-3F);
  }
}

TEST(OnnxConvolution, WhatDoesNotFitIsRefused) {
  const GraphTensor image = F({1, 4, 5, 5}, Floats(100, 1));
  const auto make = [](const OperatorArguments& a) { return RunOnednn(a); };
  ExpectRefusal(Call("Conv", {image, F({2, 3, 1, 1}, Floats(6, 1))}), make, "a kernel of 2x3x1x1");
  ExpectRefusal(Call("Conv", {image, F({3, 2, 1, 1}, Floats(6, 1))}).With("group", {2}), make, "in 2 groups");
  ExpectRefusal(Call("Conv", {image, F({2, 4, 1, 1}, Floats(8, 1)), F({3}, {1, 2, 3})}), make, "expected 2 numbers");
  ExpectRefusal(Call("Conv", {image, F({2, 4, 3, 3}, Floats(72, 1))}).With("kernel_shape", {1, 1}), make,
                "another shape than the kernel's");
  ExpectRefusal(Call("Conv", {image, F({2, 4, 7, 7}, Floats(392, 1))}), make, "a window of 7 on an image of 5");
  ExpectRefusal(Call("Conv", {image, F({2, 4, 1, 1}, Floats(8, 1))}).With("strides", {0, 1}), make, "a stride of 0x1");
  const Call fits("Conv", {image, F({2, 4, 1, 1}, Floats(8, 1))});
  const auto other = [](const OperatorArguments& a) { return RunOnednnWith(a, {}, F({1, 4, 4, 5}, Floats(80, 1))); };
  ExpectRefusal(fits, other, "an input of 1x4x4x5, expected floats of 1x4x5x5");
}

}  // namespace
}  // namespace bodyloom::onnx_operators_test
