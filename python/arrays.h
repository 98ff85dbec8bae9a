// SPDX-License-Identifier: Apache-2.0
/// NumPy arrays in and out: what comes in is checked and named when it is refused, what goes out is a view.
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

/// One axis of an expected shape: so many, or any number under a name ("T").
struct Extent {
  py::ssize_t size = -1;
  std::string name;
  Extent(py::ssize_t size) : size(size), name(std::to_string(size)) {}
  Extent(const char* name) : name(name) {}
};

template <typename T>
using RowMajorArray = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// What NumPy makes of `value` (an array, a list of lists, …), as T in C order; copied only when it is not that
/// already. Raises TypeError when it holds no real numbers and ValueError when it has another shape, both in one line:
/// "points: expected numbers of shape (T, K, 3), found shape (5, 17)".
template <typename T>
RowMajorArray<T> NumbersFrom(const py::handle& value, const char* name, const std::vector<Extent>& shape);

/// A picture: uint8, height × width × 3, red green blue. Raises as NumbersFrom() for anything else.
Image ImageFrom(const py::handle& value, const char* name);

/// The same memory as an array that cannot be written to; `owner` stays alive as long as the array does.
template <typename T>
py::array View(const T* data, std::vector<py::ssize_t> shape, const py::handle& owner);
/// The same with strides in bytes.
template <typename T>
py::array View(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               const py::handle& owner);

/// Values moved into an array that owns them.
template <typename T>
py::array ArrayOwning(std::vector<T> values, std::vector<py::ssize_t> shape);

/// Height × width × 3, red green blue, with the image's memory.
py::array PictureFrom(Image image);

/// Rows or a vector of a dynamic Eigen matrix, viewed.
template <typename Matrix>
py::array MatrixView(const Matrix& matrix, const py::handle& owner) {
  static_assert(Matrix::IsRowMajor || Matrix::IsVectorAtCompileTime, "rows of a view are contiguous");
  if constexpr (Matrix::IsVectorAtCompileTime) {
    return View(matrix.data(), {matrix.size()}, owner);
  } else {
    return View(matrix.data(), {matrix.rows(), matrix.cols()}, owner);
  }
}

/// The pose of NumPy's memory as Eigen sees it.
Eigen::VectorXd VectorFrom(const py::handle& value, const char* name, const Extent& size);

}  // namespace bodyloom::python
