// SPDX-License-Identifier: Apache-2.0
/// Operators of graphs (graph.h) that run as plain loops. Those on oneDNN: onednn_operator.h.
///
/// Two tensors are broadcast as everywhere in ONNX: their shapes are aligned at the last axis, and an axis of length 1
/// (or a missing one) is repeated to the length of the other tensor's.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "tracking/detection/inference/graph.h"

namespace bodyloom {

/// Uninitialised array, 64-byte aligned for vector kernels.
std::shared_ptr<float[]> AlignedArray(size_t size);

/// Pool of arrays for successive runs: an array that no tensor holds any more is reused.
class FloatPool {
 public:
  /// The smallest of the free arrays that are large enough, or a new one (AlignedArray()).
  std::shared_ptr<float[]> Take(size_t size);

 private:
  struct Array {
    size_t size;
    std::shared_ptr<float[]> values;
  };
  std::vector<Array> arrays_;
};

/// Array for an operator's result; converts to SharedNumbers once written.
template <typename T>
class NewNumbers {
 public:
  NewNumbers(std::shared_ptr<T[]> values, size_t size) : values_(std::move(values)), size_(size) {}
  [[nodiscard]] T* data() const { return values_.get(); }
  [[nodiscard]] size_t size() const { return size_; }
  [[nodiscard]] T* begin() const { return data(); }
  [[nodiscard]] T* end() const { return data() + size_; }
  T& operator[](size_t i) const { return data()[i]; }
  operator SharedNumbers<T>() const { return {values_, size_}; }  // NOLINT(google-explicit-constructor): once written

 private:
  std::shared_ptr<T[]> values_;
  size_t size_;
};

/// Settings shared by all operators of a graph.
struct OperatorSettings {
  int64_t opset = 0;
  bool channels_last = false;
  FloatPool* pool = nullptr;
};

/// Inputs and attributes of an operator, checked on access. Every accessor throws std::runtime_error "what was found,
/// expected what", without the node's name.
class OperatorArguments {
 public:
  /// inputs[i] is null where the node leaves one out.
  OperatorArguments(const GraphNode& node, const OperatorSettings& settings, std::span<const GraphTensor* const> inputs)
      : node_(node), settings_(settings), inputs_(inputs) {}

  [[nodiscard]] const GraphNode& node() const { return node_; }
  [[nodiscard]] int64_t opset() const { return settings_.opset; }
  [[nodiscard]] bool channels_last() const { return settings_.channels_last; }
  [[nodiscard]] size_t num_inputs() const { return inputs_.size(); }
  [[nodiscard]] bool Has(size_t i) const { return i < inputs_.size() && inputs_[i] != nullptr; }
  [[nodiscard]] const GraphTensor& Input(size_t i) const;
  /// An input that must hold floats, and its numbers.
  [[nodiscard]] const GraphTensor& FloatInput(size_t i) const;
  [[nodiscard]] const SharedNumbers<float>& Floats(size_t i) const { return FloatInput(i).floats; }
  /// The numbers of an input that must be whole.
  [[nodiscard]] const SharedNumbers<int64_t>& Ints(size_t i) const;
  /// A list of whole numbers that old operators have as an attribute and newer ones as an input; empty without either.
  [[nodiscard]] std::vector<int64_t> List(const std::string& attribute, size_t input) const;
  /// A float that is an attribute or an input likewise.
  [[nodiscard]] float Number(const std::string& attribute, size_t input, float absent) const;
  /// The attribute `axis` among `rank` axes, from 0.
  [[nodiscard]] int Axis(int64_t absent, int rank) const;
  /// Array for a result.
  template <typename T>
  [[nodiscard]] NewNumbers<T> New(size_t size) const {
    if constexpr (std::is_same_v<T, float>) return {settings_.pool->Take(size), size};
    return {std::shared_ptr<T[]>(new T[size]), size};
  }

 private:
  const GraphNode& node_;
  const OperatorSettings& settings_;
  std::span<const GraphTensor* const> inputs_;
};

using OperatorFunction = std::vector<GraphTensor> (*)(const OperatorArguments&);

/// The operator of that name; null if it is not supported.
OperatorFunction FindOperator(const std::string& name);

/// An axis among `rank`, from 0, where −1 is the last. Throws std::runtime_error for one that is not among them.
int AxisAmong(int64_t axis, int rank);
/// The shape that two shapes are broadcast to. Throws std::runtime_error when they do not fit.
std::vector<int64_t> BroadcastShape(const std::vector<int64_t>& a, const std::vector<int64_t>& b);
/// The tensor broadcast to `shape`.
GraphTensor BroadcastTo(const GraphTensor& tensor, const std::vector<int64_t>& shape);

// Elementwise operators, and reductions over axes.

/// Add, Sub, Mul, Div, Pow, Max, Min, Equal (both inputs floats or both whole numbers).
GraphTensor RunBinary(const OperatorArguments& arguments);
/// The operator Where, with inputs condition, then, else.
GraphTensor RunWhere(const OperatorArguments& arguments);
/// HardSigmoid, HardSwish, Relu, LeakyRelu, Tanh, Sqrt, Exp, Abs, Neg, Floor, Clip.
GraphTensor RunUnary(const OperatorArguments& arguments);
/// PRelu: x < 0 becomes slope · x, with the slopes (input 1) broadcast to x.
GraphTensor RunPRelu(const OperatorArguments& arguments);
/// Minimum and maximum of Clip.
std::pair<float, float> ClipBounds(const OperatorArguments& arguments);
/// ReduceSum, ReduceMean, ReduceMax, ReduceL2; all axes when none are named.
GraphTensor RunReduce(const OperatorArguments& arguments);
/// exp(x) / Σ exp(x) along an axis. Throws for files before operators 13 where an axis after it is longer than 1, since
/// those sum over all of them.
GraphTensor RunSoftmax(const OperatorArguments& arguments);

// Rearrangements, casts, shapes, ranges and constants.

GraphTensor RunConcat(const OperatorArguments& arguments);
std::vector<GraphTensor> RunSplit(const OperatorArguments& arguments);
GraphTensor RunSlice(const OperatorArguments& arguments);
GraphTensor RunTranspose(const OperatorArguments& arguments);
/// The input's axes in the order of the result's. Throws std::runtime_error for an order that is none of its axes.
std::vector<int64_t> TransposedAxes(const OperatorArguments& arguments);
GraphTensor RunGather(const OperatorArguments& arguments);
/// Writes slices at indices of the first axes.
GraphTensor RunScatterNd(const OperatorArguments& arguments);
/// Reshape, Flatten, Squeeze, Unsqueeze.
GraphTensor RunReshape(const OperatorArguments& arguments);
/// Expand, and Tile.
GraphTensor RunExpand(const OperatorArguments& arguments);
GraphTensor RunTile(const OperatorArguments& arguments);
/// Cast: all float types become float32, integers and bool int64.
GraphTensor RunCast(const OperatorArguments& arguments);
/// Shape, Constant, ConstantOfShape, Range.
GraphTensor RunShapeOf(const OperatorArguments& arguments);
GraphTensor RunConstant(const OperatorArguments& arguments);
GraphTensor RunConstantOfShape(const OperatorArguments& arguments);
GraphTensor RunRange(const OperatorArguments& arguments);

// Operators on images.

/// Attributes common to windowed operators, along the rows and the columns of the image.
struct ImageWindow {
  std::array<int64_t, 2> kernel = {}, stride = {}, dilation = {}, before = {}, after = {};

  /// Kernel lengths come from the attribute `kernel_shape`, or are those given. Throws std::runtime_error for sides
  /// outside 1 to 64, strides outside 1 to 64, padding beyond the kernel.
  ImageWindow(const OperatorArguments& arguments, std::array<int64_t, 2> kernel_lengths, std::array<int64_t, 2> image);
  /// Number of windows along an axis of that length.
  [[nodiscard]] int64_t Count(size_t axis, int64_t length, bool ceil = false) const;
};

/// An image's axes by name.
struct ImageAxes {
  int64_t count, channels, rows, columns;

  ImageAxes(const std::vector<int64_t>& shape, bool channels_last);
  /// The shape of an image with these sizes.
  [[nodiscard]] static std::vector<int64_t> Shape(int64_t count, int64_t channels, int64_t rows, int64_t columns,
                                                  bool channels_last);
};

/// Input 0. Throws std::runtime_error unless it is an image: four axes, floats.
const GraphTensor& ImageInput(const OperatorArguments& arguments);

/// The shape of the result of Resize and Upsample. Throws std::runtime_error for an interpolation other than nearest by
/// whole factors, which repeats pixels, or linear between the pixels' centres to any size.
std::vector<int64_t> ResizedShape(const OperatorArguments& arguments);

/// Pad with zeros, of a tensor of any rank.
GraphTensor RunPad(const OperatorArguments& arguments);
/// out(y·b+r, x·b+s, c) = in(y, x, (r·b+s)·C/b² + c), channels last.
GraphTensor RunDepthToSpace(const OperatorArguments& arguments);
/// Mean of each channel.
GraphTensor RunGlobalAveragePool(const OperatorArguments& arguments);
/// scale · (x − mean) / √(variance + epsilon) + bias per channel.
GraphTensor RunBatchNormalization(const OperatorArguments& arguments);

// Matrix products, on oneDNN.

/// MatMul: products over the last two axes, the others broadcast; a vector counts as one row or column.
GraphTensor RunMatMul(const OperatorArguments& arguments);
/// Gemm: alpha · A · B + beta · C, with A and B optionally transposed.
GraphTensor RunGemm(const OperatorArguments& arguments);

}  // namespace bodyloom
