// SPDX-License-Identifier: Apache-2.0
/// ONNX operators that compute number by number, and sums over axes.
///
/// Two tensors are broadcast as everywhere in ONNX: shapes are written one above the other, last axes first, and an axis
/// of length 1 (or none) stands for as many equal ones as the other tensor has.
#pragma once

#include <functional>
#include <vector>

#include "bodyloom/data_tools/detection/onnx_arguments.h"

namespace bodyloom {

/// Add, Sub, Mul, Div, Pow, Max, Min, Equal (floats or whole numbers alike in both).
OnnxTensor OnnxBinary(const OnnxArguments& arguments);
/// Where: condition, then, else.
OnnxTensor OnnxWhere(const OnnxArguments& arguments);
/// Sigmoid, HardSigmoid, HardSwish, Relu, LeakyRelu, Tanh, Sqrt, Exp, Abs, Neg, Floor, Clip.
OnnxTensor OnnxUnary(const OnnxArguments& arguments);
/// ReduceSum, ReduceMean, ReduceMax, ReduceL2; all axes when none are named.
OnnxTensor OnnxReduce(const OnnxArguments& arguments);
/// exp(x) / Σ exp(x) along an axis. Throws for files before operators 13 where an axis after it is longer than 1, since
/// those sum over all of them.
OnnxTensor OnnxSoftmax(const OnnxArguments& arguments);

/// The shape of two that are broadcast. Throws std::runtime_error when they do not fit.
std::vector<int64_t> OnnxBroadcastShape(const std::vector<int64_t>& a, const std::vector<int64_t>& b);
/// The tensor in a shape that it is broadcast to.
OnnxTensor OnnxBroadcastTo(const OnnxTensor& tensor, const std::vector<int64_t>& shape);

}  // namespace bodyloom
