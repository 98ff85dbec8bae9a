// SPDX-License-Identifier: Apache-2.0
/// Numbers of any rank, as they pass between the operators of an ONNX file.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace bodyloom {

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

}  // namespace bodyloom
