// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/graph.h"

#include <stdexcept>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kMaxNumbers = size_t{1} << 27;

const GraphAttribute* FindAttribute(const GraphNode& node, const std::string& key) {
  const auto at = node.attributes.find(key);
  return at == node.attributes.end() ? nullptr : &at->second;
}

}  // namespace

GraphTensor::GraphTensor(std::vector<int64_t> its_shape, SharedNumbers<float> values)
    : shape(std::move(its_shape)), floats(std::move(values)) {
  BODYLOOM_CHECK(floats.size() == size(), floats.size(), " numbers for a tensor of ", GraphShapeText(shape));
}

GraphTensor::GraphTensor(std::vector<int64_t> its_shape, SharedNumbers<int64_t> values)
    : shape(std::move(its_shape)), ints(std::move(values)) {
  BODYLOOM_CHECK(ints.size() == size(), ints.size(), " numbers for a tensor of ", GraphShapeText(shape));
}

size_t GraphTensor::size() const { return GraphShapeSize(shape); }

GraphTensor GraphTensor::Reshaped(std::vector<int64_t> to) const {
  BODYLOOM_CHECK(GraphShapeSize(to) == size(), GraphShapeText(shape), " cannot become ", GraphShapeText(to));
  GraphTensor result = *this;
  result.shape = std::move(to);
  return result;
}

size_t GraphShapeSize(const std::vector<int64_t>& shape) {
  size_t product = 1;
  for (const int64_t n : shape) {
    if (n < 0) throw std::runtime_error("a tensor of " + GraphShapeText(shape));
    if (n > 0 && product > kMaxNumbers / size_t(n)) {
      throw std::runtime_error(Concatenate("a tensor of ", GraphShapeText(shape), ", expected at most 2^27 numbers"));
    }
    product *= size_t(n);
  }
  return product;
}

std::string GraphShapeText(const std::vector<int64_t>& shape) {
  if (shape.empty()) return "one number";
  std::string text;
  for (const int64_t n : shape) text += (text.empty() ? "" : "x") + (n < 0 ? "?" : std::to_string(n));
  return text;
}

int64_t GraphNode::Integer(const std::string& key, int64_t absent) const {
  const GraphAttribute* attribute = FindAttribute(*this, key);
  return attribute == nullptr || attribute->ints.empty() ? absent : attribute->ints[0];
}

float GraphNode::Float(const std::string& key, float absent) const {
  const GraphAttribute* attribute = FindAttribute(*this, key);
  return attribute == nullptr || attribute->floats.empty() ? absent : attribute->floats[0];
}

std::vector<int64_t> GraphNode::Integers(const std::string& key, const std::vector<int64_t>& absent) const {
  const GraphAttribute* attribute = FindAttribute(*this, key);
  return attribute == nullptr ? absent : attribute->ints;
}

std::string GraphNode::Text(const std::string& key, const std::string& absent) const {
  const GraphAttribute* attribute = FindAttribute(*this, key);
  return attribute == nullptr ? absent : attribute->text;
}

}  // namespace bodyloom
