// SPDX-License-Identifier: Apache-2.0
/// Makes small .tflite files (tracking/detection/inference/tflite_reader.h), valid or with faults set by a test.
#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/tracking/detection/inference/flatbuffer_writer.h"

namespace bodyloom {

/// Half precision; exact for representable, not subnormal numbers.
inline uint16_t HalfOf(float value) {
  if (value == 0) return 0;
  const auto bits = std::bit_cast<uint32_t>(value);
  return static_cast<uint16_t>((bits >> 16 & 0x8000) | ((bits >> 23 & 255) - 112) << 10 | (bits >> 13 & 1023));
}

/// Multiples of 1/16 in (−4, 4), which are exact in half precision; some are 0.
inline std::vector<float> SomeFloats(size_t count, uint32_t seed) {
  std::vector<float> values(count);
  for (float& value : values) {
    seed = seed * 1664525U + 1013904223U;
    value = static_cast<float>(static_cast<int>(seed >> 25) - 64) / 16.0F;
  }
  return values;
}

inline size_t SizeOfShape(const std::vector<int>& shape) {
  size_t size = 1;
  for (const int n : shape) size *= static_cast<size_t>(n);
  return size;
}

class TfliteWriter {
 public:
  enum Code : int {
    kAdd = 0,
    kConcatenation = 2,
    kConv2d = 3,
    kDepthwiseConv2d = 4,
    kDepthToSpace = 5,
    kDequantize = 6,
    kFullyConnected = 9,
    kLogistic = 14,
    kMaxPool2d = 17,
    kReshape = 22,
    kResizeBilinear = 23,
    kPad = 34,
    kMean = 40,
    kStridedSlice = 45,
    kPrelu = 54,
    kDensify = 124
  };
  enum class Storage { kFloat32, kFloat16, kSparse };
  using Options = std::map<int, int>;

  /// Adds a computed tensor or an input.
  int Tensor(const std::vector<int>& shape, int type = 0) { return Add(shape, type, ""); }
  int Input(const std::vector<int>& shape) {
    inputs.push_back(Tensor(shape));
    return inputs.back();
  }
  int Ints(const std::vector<int>& shape, const std::vector<int32_t>& values) { return Add(shape, 2, Raw(values)); }
  /// Adds a float32 tensor, by DEQUANTIZE and DENSIFY where the storage needs them.
  int Floats(const std::vector<int>& shape, const std::vector<float>& values, Storage storage = Storage::kFloat32) {
    if (storage == Storage::kFloat32) return Add(shape, 0, Raw(values));
    int half = 0;
    if (storage == Storage::kFloat16) {
      half = Add(shape, 1, Raw(Halves(values)));
    } else {
      half = Apply(kDensify, {Sparse(shape, values)}, shape, {}, 1);
    }
    return Apply(kDequantize, {half}, shape);
  }
  /// A float16 constant in rows of the last axis. Column numbers of kind 1 int32, 2 uint16 or 3 uint8.
  int Sparse(const std::vector<int>& shape, const std::vector<float>& values, int kind = 3) {
    const auto columns = static_cast<size_t>(shape.back());
    std::vector<int32_t> starts = {0}, places;
    std::vector<float> there;
    for (size_t i = 0; i < values.size(); ++i) {
      if (values[i] != 0) {
        places.push_back(static_cast<int32_t>(i % columns));
        there.push_back(values[i]);
      }
      if (i % columns == columns - 1) starts.push_back(static_cast<int32_t>(there.size()));
    }
    std::vector<int32_t> order;
    std::vector<FlatNode> dimensions;
    for (size_t i = 0; i < shape.size(); ++i) {
      order.push_back(static_cast<int32_t>(i));
      dimensions.push_back(FlatNode::Table());
      if (i + 1 < shape.size()) dimensions.back().Set(1, shape[i]);
    }
    dimensions.back().Set(0, 1).Set(2, 1).Set(3, FlatNode::Table().Set(0, FlatNode::Numbers(starts)));
    dimensions.back().Set(4, kind).Set(5, FlatNode::Table().Set(0, OfKind(places, kind)));
    const int tensor = Add(shape, 1, Raw(Halves(there)));
    tensors[static_cast<size_t>(tensor)].Set(
        6, FlatNode::Table().Set(0, FlatNode::Numbers(order)).Set(2, FlatNode::List(dimensions)));
    return tensor;
  }

  /// Adds an operator; returns the tensor that it writes.
  int Apply(int code, const std::vector<int32_t>& operands, const std::vector<int>& shape, const Options& options = {},
            int type = 0) {
    const int output = Tensor(shape, type);
    Operator(code, operands, output, options);
    return output;
  }
  void Operator(int code, const std::vector<int32_t>& operands, int output, const Options& options = {}) {
    static const std::map<int, int> kKinds = {
        {kAdd, 11},           {kConcatenation, 10}, {kConv2d, 1}, {kDepthwiseConv2d, 2}, {kDepthToSpace, 94},
        {kFullyConnected, 8}, {kMaxPool2d, 5},      {kMean, 27},  {kResizeBilinear, 15}, {kStridedSlice, 32}};
    FlatNode table = FlatNode::Table();
    table.Set(0, static_cast<int32_t>(codes.size()));
    codes.push_back(FlatNode::Table().Set(code < 127 ? 0 : 3, code));
    table.Set(1, FlatNode::Numbers(operands)).Set(2, FlatNode::Numbers(std::vector<int32_t>{output}));
    if (const auto kind = kKinds.find(code); kind != kKinds.end()) {
      FlatNode node = FlatNode::Table();
      for (const auto& [field, value] : options) node.Set(field, value);
      table.Set(3, kind->second).Set(4, node);
    }
    operators.push_back(table);
  }

  int Conv(int input, const std::vector<int>& kernel_shape, const std::vector<int>& shape, bool same, int stride,
           bool relu6 = false, Storage storage = Storage::kFloat16, bool bias = true) {
    const uint32_t seed = static_cast<uint32_t>(operators.size()) + 7;
    const int kernel = Floats(kernel_shape, SomeFloats(SizeOfShape(kernel_shape), seed), storage);
    const int offsets =
        bias ? Floats({kernel_shape[0]}, SomeFloats(static_cast<size_t>(kernel_shape[0]), seed + 1)) : -1;
    return Apply(kConv2d, {input, kernel, offsets}, shape,
                 {{0, same ? 0 : 1}, {1, stride}, {2, stride}, {3, relu6 ? 3 : 0}});
  }
  int Depthwise(int input, int height, int width, const std::vector<int>& shape, bool same, int stride,
                bool relu6 = false) {
    const uint32_t seed = static_cast<uint32_t>(operators.size()) + 11;
    const std::vector<int> kernel_shape = {1, height, width, shape[3]};
    const int kernel = Floats(kernel_shape, SomeFloats(SizeOfShape(kernel_shape), seed), Storage::kFloat16);
    const int bias = Floats({shape[3]}, SomeFloats(static_cast<size_t>(shape[3]), seed + 1), Storage::kFloat16);
    return Apply(kDepthwiseConv2d, {input, kernel, bias}, shape,
                 {{0, same ? 0 : 1}, {1, stride}, {2, stride}, {3, 1}, {4, relu6 ? 3 : 0}});
  }
  int Pad(int input, const std::vector<int32_t>& paddings, const std::vector<int>& shape) {
    return Apply(kPad, {input, Ints({4, 2}, paddings)}, shape);
  }

  [[nodiscard]] std::string Bytes() const {
    FlatNode graph = FlatNode::Table();
    graph.Set(0, FlatNode::List(tensors)).Set(1, FlatNode::Numbers(inputs)).Set(2, FlatNode::Numbers(outputs));
    graph.Set(3, FlatNode::List(operators));
    FlatNode model = FlatNode::Table().Set(0, version).Set(1, FlatNode::List(codes));
    model.Set(2, FlatNode::List(std::vector<FlatNode>(static_cast<size_t>(num_graphs), graph)));
    model.Set(4, FlatNode::List(buffers));
    return model.File("TFL3");
  }

  int32_t version = 3;
  int num_graphs = 1;
  std::vector<int32_t> inputs, outputs;
  std::vector<FlatNode> tensors, codes, operators;
  std::vector<FlatNode> buffers = {FlatNode::Table()};  // the first holds nothing, for all that is computed

 private:
  template <typename T>
  static std::string Raw(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
  }
  static std::vector<uint16_t> Halves(const std::vector<float>& values) {
    std::vector<uint16_t> halves;
    halves.reserve(values.size());
    for (const float value : values) halves.push_back(HalfOf(value));
    return halves;
  }
  static FlatNode OfKind(const std::vector<int32_t>& values, int kind) {
    if (kind == 2) return FlatNode::Numbers(std::vector<uint16_t>(values.begin(), values.end()));
    if (kind == 3) return FlatNode::Numbers(std::vector<uint8_t>(values.begin(), values.end()));
    return FlatNode::Numbers(values);
  }
  int Add(const std::vector<int>& shape, int type, const std::string& bytes) {
    const auto number = static_cast<int>(tensors.size());
    int buffer = 0;
    if (!bytes.empty()) {
      buffer = static_cast<int>(buffers.size());
      buffers.push_back(FlatNode::Table().Set(0, FlatNode::Text(bytes)));
    }
    FlatNode table = FlatNode::Table();
    table.Set(0, FlatNode::Numbers(std::vector<int32_t>(shape.begin(), shape.end()))).Set(1, type).Set(2, buffer);
    table.Set(3, FlatNode::Text("t" + std::to_string(number)));
    tensors.push_back(table);
    return number;
  }
};

}  // namespace bodyloom
