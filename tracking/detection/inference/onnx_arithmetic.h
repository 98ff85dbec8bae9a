// SPDX-License-Identifier: Apache-2.0
/// ONNX operators that compute number by number, and sums over axes.
///
/// Two tensors are broadcast as everywhere in ONNX: shapes are written one above the other, last axes first, and an
/// axis of length 1 (or none) stands for as many equal ones as the other tensor has.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tracking/detection/inference/onnx_model.h"

namespace bodyloom {

// What an operator of an ONNX file is given: its inputs and attributes, checked as they are asked for.

/// Every request throws std::runtime_error "what was found, expected what", without a place.
class OnnxArguments {
 public:
  /// inputs[i] is null where the node leaves one out.
  OnnxArguments(const OnnxNode& node, int64_t opset, std::span<const OnnxTensor* const> inputs)
      : node_(node), opset_(opset), inputs_(inputs) {}

  [[nodiscard]] const OnnxNode& node() const { return node_; }
  [[nodiscard]] int64_t opset() const { return opset_; }
  [[nodiscard]] size_t num_inputs() const { return inputs_.size(); }
  [[nodiscard]] bool Has(size_t i) const { return i < inputs_.size() && inputs_[i] != nullptr; }
  [[nodiscard]] const OnnxTensor& Input(size_t i) const;
  /// An input that must hold floats, and its numbers.
  [[nodiscard]] const OnnxTensor& FloatInput(size_t i) const;
  [[nodiscard]] const std::vector<float>& Floats(size_t i) const { return *FloatInput(i).floats; }
  /// The numbers of an input that must be whole.
  [[nodiscard]] const std::vector<int64_t>& Ints(size_t i) const;
  /// A list of whole numbers that old operators have as an attribute and newer ones as an input; empty when neither is
  /// there.
  [[nodiscard]] std::vector<int64_t> List(const std::string& attribute, size_t input) const;
  /// A float of the same two kinds.
  [[nodiscard]] float Number(const std::string& attribute, size_t input, float absent) const;
  /// The attribute `axis` among so many, from 0.
  [[nodiscard]] int Axis(int64_t absent, int rank) const;

 private:
  const OnnxNode& node_;
  int64_t opset_;
  std::span<const OnnxTensor* const> inputs_;
};

/// An axis among `rank`, from 0, where −1 is the last. Throws std::runtime_error for one that is not among them.
int OnnxAxis(int64_t axis, int rank);

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
