// SPDX-License-Identifier: Apache-2.0
/// Networks in ONNX files (.onnx): the graph as it is stored.
///
/// The file is one message of Protocol Buffers (protobuf.h). Messages, fields by number:
///   Model      7 graph, 8 operator sets (1 domain, 2 version); the others say who wrote the file
///   Graph      1 nodes, each after those whose results it takes; 5 constants; 11 inputs, 12 outputs
///   Node       1 inputs and 2 outputs by name (an empty input is left out), 3 name, 4 operator, 5 attributes, 7 domain
///   Attribute  1 name, 2 float, 3 whole number, 4 text, 5 tensor, 7 floats, 8 whole numbers; 6, 10, 11 are graphs
///   Tensor     1 shape, 2 type, 8 name, 9 the numbers as they lie, or 4 float32, 5 int32, 7 int64, 10 double one by
///              one; 14 is 1 when they are in another file
///   Value      1 name, 2 type (1 tensor: 1 type of its numbers, 2 shape: 1 axes: 1 length, or 2 a name: dynamic)
/// Types: 1 float32, 10 float16, 6 int32, 7 int64, 9 bool. Float16 becomes float32, the others int64.
///
/// Source: github.com/onnx/onnx, onnx.proto3.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bodyloom {

// Numbers of any rank, as they pass between the operators of an ONNX file.

/// Float32 or whole numbers in C order: the last axis is the fastest. Copies share the numbers, which nobody changes.
struct OnnxTensor {
  std::vector<int64_t> shape;  ///< none: a single number
  std::shared_ptr<const std::vector<float>> floats;
  std::shared_ptr<const std::vector<int64_t>> ints;  ///< when `floats` is null

  OnnxTensor() = default;
  /// Throws std::invalid_argument when there are other than size() numbers.
  OnnxTensor(std::vector<int64_t> shape, std::vector<float> values);
  OnnxTensor(std::vector<int64_t> shape, std::vector<int64_t> values);

  [[nodiscard]] bool has_floats() const { return floats != nullptr; }
  [[nodiscard]] int rank() const { return int(shape.size()); }
  [[nodiscard]] size_t size() const;
  /// The same numbers in another shape of equally many.
  [[nodiscard]] OnnxTensor Reshaped(std::vector<int64_t> to) const;
};

/// Product of a shape's numbers. Throws std::runtime_error "what was found" for one that is negative, and beyond 2²⁷.
size_t OnnxShapeSize(const std::vector<int64_t>& shape);

/// "1x56x8400", −1 as "?"; "one number" for no axes.
std::string OnnxShapeText(const std::vector<int64_t>& shape);

struct OnnxAttribute {
  std::vector<int64_t> ints;  ///< one, for a whole number
  std::vector<float> floats;  ///< one, for a float
  std::string text;
  OnnxTensor tensor;  ///< of type tensor
};

struct OnnxNode {
  std::string name, op;                             ///< printable
  std::vector<int> inputs, outputs;                 ///< numbers of tensors; −1: left out
  std::map<std::string, OnnxAttribute> attributes;  ///< by name

  /// Attributes that have a default in the standard.
  [[nodiscard]] int64_t Integer(const std::string& key, int64_t absent) const;
  [[nodiscard]] float Float(const std::string& key, float absent) const;
  [[nodiscard]] std::vector<int64_t> Integers(const std::string& key, const std::vector<int64_t>& absent) const;
  [[nodiscard]] std::string Text(const std::string& key, const std::string& absent) const;
  [[nodiscard]] bool Has(const std::string& key) const { return attributes.contains(key); }
};

struct OnnxModel {
  std::string name;             ///< of its file, for messages
  int64_t opset = 0;            ///< version of the standard's operators
  std::vector<OnnxNode> nodes;  ///< each after those whose results it takes; no tensor is written twice
  int num_tensors = 0;
  std::map<int, OnnxTensor> constants;
  int input = 0;                     ///< the one that is no constant
  std::vector<int64_t> input_shape;  ///< −1 where an axis is dynamic
  std::vector<int> outputs;
};

/// Checks all that is said above. Bounds: a file of at most 1 GB, 20,000 nodes, 100 attributes a node, 8 axes a tensor,
/// constants of at most 16 times the file's bytes. Throws std::runtime_error "path: place: what was found, expected
/// what" for anything else: another type, weights in another file, graphs within the graph, other than one input,
/// operators of another domain than the standard's.
OnnxModel ReadOnnxModel(const std::string& path);
OnnxModel ParseOnnxModel(std::string_view bytes, const std::string& name);

}  // namespace bodyloom
