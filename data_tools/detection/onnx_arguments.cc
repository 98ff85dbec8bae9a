// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/detection/onnx_arguments.h"

#include <stdexcept>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

const OnnxTensor& OnnxArguments::Input(size_t i) const {
  if (!Has(i)) throw std::runtime_error(Concatenate("input ", i, " is missing"));
  return *inputs_[i];
}

const OnnxTensor& OnnxArguments::FloatInput(size_t i) const {
  const OnnxTensor& input = Input(i);
  if (!input.has_floats()) throw std::runtime_error(Concatenate("input ", i, " holds whole numbers, expected floats"));
  return input;
}

const std::vector<int64_t>& OnnxArguments::Ints(size_t i) const {
  const OnnxTensor& input = Input(i);
  if (input.has_floats()) throw std::runtime_error(Concatenate("input ", i, " holds floats, expected whole numbers"));
  return *input.ints;
}

std::vector<int64_t> OnnxArguments::List(const std::string& attribute, size_t input) const {
  return Has(input) ? Ints(input) : node_.Integers(attribute, {});
}

float OnnxArguments::Number(const std::string& attribute, size_t input, float absent) const {
  if (!Has(input)) return node_.Float(attribute, absent);
  const std::vector<float>& values = Floats(input);
  if (values.size() != 1)
    throw std::runtime_error(Concatenate("input ", input, ": ", values.size(), " numbers, expected 1"));
  return values[0];
}

int OnnxArguments::Axis(int64_t absent, int rank) const { return OnnxAxis(node_.Integer("axis", absent), rank); }

int OnnxAxis(int64_t axis, int rank) {
  if (axis < -rank || axis >= rank) throw std::runtime_error(Concatenate("axis ", axis, " of ", rank));
  return int(axis < 0 ? axis + rank : axis);
}

}  // namespace bodyloom
