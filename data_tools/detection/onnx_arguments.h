// SPDX-License-Identifier: Apache-2.0
/// What an operator of an ONNX file is given: its inputs and attributes, checked as they are asked for.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bodyloom/data_tools/detection/onnx_model.h"

namespace bodyloom {

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

}  // namespace bodyloom
