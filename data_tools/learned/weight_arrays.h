// SPDX-License-Identifier: Apache-2.0
/// Conversion of matrices and vectors of network weights to and from arrays of a .npz file.
#pragma once

#include <Eigen/Core>
#include <string>

#include "data_tools/formats/npz.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

/// Converts a matrix, rounded to half precision (11 bits).
NdArray HalfMatrix(const RowMatrixXf& matrix);
NdArray FloatVector(const Eigen::VectorXf& vector);
NdArray FloatNumber(float number);

/// Throw std::runtime_error naming the file, the array and what was expected.
RowMatrixXf MatrixFrom(const NpzArrays& arrays, const std::string& name, const std::string& where);
Eigen::VectorXf VectorFrom(const NpzArrays& arrays, const std::string& name, const std::string& where);
/// Returns the single number of an array.
float NumberFrom(const NpzArrays& arrays, const std::string& name, const std::string& where);
/// Returns the text of `recipe`, which may be empty but must exist.
std::string RecipeFrom(const NpzArrays& arrays, const std::string& where);

}  // namespace bodyloom
