// SPDX-License-Identifier: Apache-2.0
#include "data_tools/learned/weight_arrays.h"

#include <cstring>
#include <stdexcept>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

std::vector<float> FloatsFrom(const NdArray& array, const std::string& name, size_t dimensions,
                              const std::string& where) {
  const bool is_float = array.dtype == DType::kF16 || array.dtype == DType::kF32 || array.dtype == DType::kF64;
  if (!is_float || array.shape.size() != dimensions || array.num_elements() == 0) {
    throw std::runtime_error(where + ": " + name + " is " + array.ShapeText() + ", expected floating point numbers, " +
                             (dimensions == 2 ? "rows x columns" : "one row"));
  }
  return array.ToFloats();
}

}  // namespace

NdArray HalfMatrix(const RowMatrixXf& matrix) {
  NdArray array;
  array.dtype = DType::kF16;
  array.shape = {matrix.rows(), matrix.cols()};
  array.item_size = 2;
  array.bytes.resize(2 * size_t(matrix.size()));
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    const uint16_t bits = Eigen::half(matrix.data()[i]).x;
    std::memcpy(&array.bytes[2 * size_t(i)], &bits, 2);
  }
  return array;
}

NdArray FloatVector(const Eigen::VectorXf& vector) { return NdArray::FromFloats(vector.data(), {vector.size()}); }

NdArray FloatNumber(float number) { return NdArray::FromFloats(&number, {1}); }

RowMatrixXf MatrixFrom(const NpzArrays& arrays, const std::string& name, const std::string& where) {
  const NdArray& array = RequireArray(arrays, name, where);
  const std::vector<float> values = FloatsFrom(array, name, 2, where);
  return Eigen::Map<const RowMatrixXf>(values.data(), array.shape[0], array.shape[1]);
}

Eigen::VectorXf VectorFrom(const NpzArrays& arrays, const std::string& name, const std::string& where) {
  const std::vector<float> values = FloatsFrom(RequireArray(arrays, name, where), name, 1, where);
  return Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size()));
}

float NumberFrom(const NpzArrays& arrays, const std::string& name, const std::string& where) {
  const Eigen::VectorXf numbers = VectorFrom(arrays, name, where);
  if (numbers.size() != 1) {
    throw std::runtime_error(Concatenate(where, ": ", name, " has ", numbers.size(), " numbers, expected one"));
  }
  return numbers[0];
}

std::string RecipeFrom(const NpzArrays& arrays, const std::string& where) {
  const std::vector<std::string> recipe = RequireArray(arrays, "recipe", where).ToStrings();
  return recipe.empty() ? "" : recipe[0];
}

}  // namespace bodyloom
