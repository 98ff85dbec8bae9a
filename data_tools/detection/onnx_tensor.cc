// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/detection/onnx_tensor.h"

#include <stdexcept>
#include <utility>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kMostNumbers = size_t{1} << 27;

}  // namespace

OnnxTensor::OnnxTensor(std::vector<int64_t> its_shape, std::vector<float> values)
    : shape(std::move(its_shape)), floats(std::make_shared<const std::vector<float>>(std::move(values))) {
  BODYLOOM_CHECK(floats->size() == size(), floats->size(), " numbers for a tensor of ", OnnxShapeText(shape));
}

OnnxTensor::OnnxTensor(std::vector<int64_t> its_shape, std::vector<int64_t> values)
    : shape(std::move(its_shape)), ints(std::make_shared<const std::vector<int64_t>>(std::move(values))) {
  BODYLOOM_CHECK(ints->size() == size(), ints->size(), " numbers for a tensor of ", OnnxShapeText(shape));
}

size_t OnnxTensor::size() const { return OnnxShapeSize(shape); }

OnnxTensor OnnxTensor::Reshaped(std::vector<int64_t> to) const {
  BODYLOOM_CHECK(OnnxShapeSize(to) == size(), OnnxShapeText(shape), " cannot become ", OnnxShapeText(to));
  OnnxTensor result = *this;
  result.shape = std::move(to);
  return result;
}

size_t OnnxShapeSize(const std::vector<int64_t>& shape) {
  size_t product = 1;
  for (const int64_t n : shape) {
    if (n < 0) throw std::runtime_error("a tensor of " + OnnxShapeText(shape));
    if (n > 0 && product > kMostNumbers / size_t(n)) {
      throw std::runtime_error(Concatenate("a tensor of ", OnnxShapeText(shape), ", expected at most 2^27 numbers"));
    }
    product *= size_t(n);
  }
  return product;
}

std::string OnnxShapeText(const std::vector<int64_t>& shape) {
  if (shape.empty()) return "one number";
  std::string text;
  for (const int64_t n : shape) text += (text.empty() ? "" : "x") + (n < 0 ? "?" : std::to_string(n));
  return text;
}

}  // namespace bodyloom
