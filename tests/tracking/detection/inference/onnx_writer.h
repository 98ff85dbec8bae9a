// SPDX-License-Identifier: Apache-2.0
/// Makes small .onnx files (tracking/detection/inference/onnx_reader.h), valid or with faults set by a test.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace bodyloom {

/// A message of Protocol Buffers, field after field.
class ProtoWriter {
 public:
  ProtoWriter& Varint(uint32_t field, uint64_t value) {
    Number(uint64_t{field} << 3);
    return Number(value);
  }
  ProtoWriter& Bytes(uint32_t field, std::string_view value) {
    Number(uint64_t{field} << 3 | 2);
    Number(value.size());
    bytes_ += value;
    return *this;
  }
  ProtoWriter& Message(uint32_t field, const ProtoWriter& message) { return Bytes(field, message.bytes_); }
  ProtoWriter& Float(uint32_t field, float value) {
    Number(uint64_t{field} << 3 | 5);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
    return *this;
  }
  ProtoWriter& Number(uint64_t value) {
    for (; value > 127; value >>= 7) bytes_ += static_cast<char>(value | 128);
    bytes_ += static_cast<char>(value);
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class OnnxWriter {
 public:
  enum Type { kFloat = 1, kInt32 = 6, kInt64 = 7, kBool = 9, kHalf = 10 };

  /// An attribute's message.
  static ProtoWriter Integer(const std::string& name, int64_t value) {
    return ProtoWriter().Bytes(1, name).Varint(3, static_cast<uint64_t>(value));
  }
  static ProtoWriter Integers(const std::string& name, const std::vector<int64_t>& values) {
    ProtoWriter attribute = ProtoWriter().Bytes(1, name);
    for (const int64_t value : values) attribute.Varint(8, static_cast<uint64_t>(value));
    return attribute;
  }
  static ProtoWriter Float(const std::string& name, float value) {
    return ProtoWriter().Bytes(1, name).Float(2, value);
  }
  static ProtoWriter Text(const std::string& name, const std::string& value) {
    return ProtoWriter().Bytes(1, name).Bytes(4, value);
  }
  static ProtoWriter TensorOf(const std::string& name, const ProtoWriter& tensor) {
    return ProtoWriter().Bytes(1, name).Message(5, tensor);
  }

  /// A tensor's message with raw numbers.
  template <typename T>
  static ProtoWriter Tensor(const std::string& name, Type type, const std::vector<int64_t>& shape,
                            const std::vector<T>& values) {
    ProtoWriter tensor;
    for (const int64_t n : shape) tensor.Varint(1, static_cast<uint64_t>(n));
    tensor.Varint(2, type).Bytes(8, name);
    return tensor.Bytes(9, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  }

  /// The name and the shape of an input or output; −1 is dynamic.
  static ProtoWriter Value(const std::string& name, const std::vector<int64_t>& shape) {
    ProtoWriter axes;
    for (const int64_t n : shape) {
      axes.Message(1, n < 0 ? ProtoWriter().Bytes(2, "batch") : ProtoWriter().Varint(1, static_cast<uint64_t>(n)));
    }
    const ProtoWriter tensor = ProtoWriter().Varint(1, kFloat).Message(2, axes);
    return ProtoWriter().Bytes(1, name).Message(2, ProtoWriter().Message(1, tensor));
  }

  OnnxWriter& Input(const std::string& name, const std::vector<int64_t>& shape) {
    graph.Message(11, Value(name, shape));
    return *this;
  }
  OnnxWriter& Output(const std::string& name) {
    graph.Message(12, Value(name, {}));
    return *this;
  }
  OnnxWriter& Floats(const std::string& name, const std::vector<int64_t>& shape, const std::vector<float>& values) {
    graph.Message(5, Tensor(name, kFloat, shape, values));
    return *this;
  }
  OnnxWriter& Ints(const std::string& name, const std::vector<int64_t>& shape, const std::vector<int64_t>& values) {
    graph.Message(5, Tensor(name, kInt64, shape, values));
    return *this;
  }
  OnnxWriter& Node(const std::string& op, const std::vector<std::string>& inputs,
                   const std::vector<std::string>& outputs, const std::vector<ProtoWriter>& attributes = {},
                   const std::string& domain = "") {
    ProtoWriter node;
    for (const std::string& input : inputs) node.Bytes(1, input);
    for (const std::string& output : outputs) node.Bytes(2, output);
    node.Bytes(3, "/" + op).Bytes(4, op);
    for (const ProtoWriter& attribute : attributes) node.Message(5, attribute);
    if (!domain.empty()) node.Bytes(7, domain);
    graph.Message(1, node);
    return *this;
  }

  [[nodiscard]] std::string Bytes() const {
    return ProtoWriter()
        .Varint(1, 8)
        .Bytes(2, "test")
        .Message(7, graph)
        .Message(8, ProtoWriter().Varint(2, static_cast<uint64_t>(opset)))
        .bytes();
  }

  ProtoWriter graph;
  int64_t opset = 17;
};

}  // namespace bodyloom
