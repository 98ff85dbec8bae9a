// SPDX-License-Identifier: Apache-2.0
/// Conversion of NumPy arrays: inputs are checked, with errors that name them; outputs are views.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "render/image/image.h"

namespace bodyloom::python {

namespace py = pybind11;

/// One axis of an expected shape: a fixed size, or any size under a name ("T").
struct Extent {
  py::ssize_t size = -1;
  std::string name;
  Extent(py::ssize_t size) : size(size), name(std::to_string(size)) {}
  Extent(const char* name) : name(name) {}
};

template <typename T>
using RowMajorArray = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// Converts `value` (an array, a list of lists, …) to an array of T in C order, without a copy if it is one already.
/// Raises TypeError if it is not real numbers and ValueError if it has another shape, both in one line: "points:
/// expected numbers of shape (T, K, 3), found shape (5, 17)".
template <typename T>
RowMajorArray<T> NumbersFrom(const py::handle& value, const char* name, const std::vector<Extent>& shape);

/// Converts an image: uint8, height × width × 3, RGB. Raises as NumbersFrom() for anything else.
Image ImageFrom(const py::handle& value, const char* name);

/// Read-only array that shares the memory; `owner` is kept alive as long as the array.
template <typename T>
py::array View(const T* data, std::vector<py::ssize_t> shape, const py::handle& owner);
/// The same with strides in bytes.
template <typename T>
py::array View(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               const py::handle& owner);

/// Moves values into an array that owns them.
template <typename T>
py::array ArrayOwning(std::vector<T> values, std::vector<py::ssize_t> shape);

/// Array of height × width × 3, RGB, that takes over the image's memory.
py::array ArrayFromImage(Image image);

/// View of a dynamic Eigen matrix or vector.
template <typename Matrix>
py::array MatrixView(const Matrix& matrix, const py::handle& owner) {
  static_assert(Matrix::IsRowMajor || Matrix::IsVectorAtCompileTime, "rows of a view are contiguous");
  if constexpr (Matrix::IsVectorAtCompileTime) {
    return View(matrix.data(), {matrix.size()}, owner);
  } else {
    return View(matrix.data(), {matrix.rows(), matrix.cols()}, owner);
  }
}

/// Copies a vector of this size from NumPy. Raises as NumbersFrom().
Eigen::VectorXd VectorFrom(const py::handle& value, const char* name, const Extent& size);

}  // namespace bodyloom::python
