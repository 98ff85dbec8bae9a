// SPDX-License-Identifier: Apache-2.0
/// Networks as graphs of operators. They are built from files (onnx_reader.h, tflite_reader.h) or from the weights of
/// an image U-Net (image_unet_runner.h), and run by graph_executor.h.
///
/// Operators have the names, inputs and attributes of the ONNX standard (github.com/onnx/onnx, Operators.md), in the
/// version `opset`. Images are N×C×H×W; in a graph with `channels_last` they are N×H×W×C, kernels of convolutions
/// out × height × width × in (1 × height × width × channels with a group a channel), and attributes that count axes
/// count those. Lists that newer versions have as an input may be attributes too, as in older ones.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

/// Immutable array of numbers; copies share the memory.
template <typename T>
class SharedNumbers {
 public:
  using value_type = T;
  using const_iterator = const T*;

  SharedNumbers() = default;
  SharedNumbers(std::vector<T> values)  // NOLINT(google-explicit-constructor): a list of numbers is one
      : SharedNumbers(std::make_shared<const std::vector<T>>(std::move(values))) {}
  SharedNumbers(const std::shared_ptr<const T[]>& values, size_t size)
      : owner_(values), data_(values.get()), size_(size) {}

  [[nodiscard]] bool is_set() const { return owner_ != nullptr; }
  [[nodiscard]] size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const T* data() const { return data_; }
  [[nodiscard]] const T* begin() const { return data_; }
  [[nodiscard]] const T* end() const { return data_ + size_; }
  const T& operator[](size_t i) const { return data_[i]; }
  friend bool operator==(const SharedNumbers& a, const SharedNumbers& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }
  [[nodiscard]] std::vector<T> Copy() const { return {begin(), end()}; }
  /// Number of objects that share these numbers.
  [[nodiscard]] long num_holders() const { return owner_.use_count(); }
  /// Mutable access for overwriting the numbers. No other holder may read them afterwards.
  [[nodiscard]] std::shared_ptr<T[]> Overwritten() const {
    return {std::const_pointer_cast<void>(owner_), const_cast<T*>(data_)};
  }

 private:
  explicit SharedNumbers(std::shared_ptr<const std::vector<T>> values) : data_(values->data()), size_(values->size()) {
    owner_ = std::move(values);
  }

  std::shared_ptr<const void> owner_;
  const T* data_ = nullptr;
  size_t size_ = 0;
};

/// Float32 or whole numbers of any rank in C order: the last axis is the fastest.
struct GraphTensor {
  std::vector<int64_t> shape;  ///< none: a single number
  SharedNumbers<float> floats;
  SharedNumbers<int64_t> ints;  ///< when `floats` is not set

  GraphTensor() = default;
  /// Throws std::invalid_argument when there are other than size() numbers.
  GraphTensor(std::vector<int64_t> shape, SharedNumbers<float> values);
  GraphTensor(std::vector<int64_t> shape, SharedNumbers<int64_t> values);

  [[nodiscard]] bool has_floats() const { return floats.is_set(); }
  [[nodiscard]] bool has_numbers() const { return floats.is_set() || ints.is_set(); }
  [[nodiscard]] int rank() const { return int(shape.size()); }
  [[nodiscard]] size_t size() const;
  /// The same numbers in another shape of equally many.
  [[nodiscard]] GraphTensor Reshaped(std::vector<int64_t> to) const;
};

/// Product of a shape's numbers. Throws std::runtime_error "what was found" for one that is negative, and beyond 2²⁷.
size_t GraphShapeSize(const std::vector<int64_t>& shape);

/// "1x56x8400", −1 as "?"; "one number" for no axes.
std::string GraphShapeText(const std::vector<int64_t>& shape);

struct GraphAttribute {
  std::vector<int64_t> ints;  ///< one, for a whole number
  std::vector<float> floats;  ///< one, for a float
  std::string text;
  GraphTensor tensor;  ///< of type tensor

  static GraphAttribute Ints(std::vector<int64_t> numbers) { return {std::move(numbers), {}, {}, {}}; }
  static GraphAttribute Floats(std::vector<float> numbers) { return {{}, std::move(numbers), {}, {}}; }
  static GraphAttribute Text(std::string words) { return {{}, {}, std::move(words), {}}; }
};

struct GraphNode {
  std::string name, op;                              ///< printable
  std::vector<int> inputs, outputs;                  ///< places among the tensors; −1: left out
  std::map<std::string, GraphAttribute> attributes;  ///< by name

  /// Attributes that have a default in the standard.
  [[nodiscard]] int64_t Integer(const std::string& key, int64_t absent) const;
  [[nodiscard]] float Float(const std::string& key, float absent) const;
  [[nodiscard]] std::vector<int64_t> Integers(const std::string& key, const std::vector<int64_t>& absent) const;
  [[nodiscard]] std::string Text(const std::string& key, const std::string& absent) const;
  [[nodiscard]] bool Has(const std::string& key) const { return attributes.contains(key); }
};

struct OperatorGraph {
  struct Tensor {
    std::string name;            ///< printable
    std::vector<int64_t> shape;  ///< of an input and of a constant; of others if the file has it; −1: any length
    GraphTensor constant;        ///< without numbers for computed tensors
  };

  std::string name;   ///< of its file, for messages
  int64_t opset = 0;  ///< version of the standard's operators
  bool channels_last = false;
  std::vector<Tensor> tensors;
  std::vector<GraphNode> nodes;      ///< each after those whose results it takes; no tensor is written twice
  std::vector<int> inputs, outputs;  ///< places among the tensors
};

}  // namespace bodyloom
