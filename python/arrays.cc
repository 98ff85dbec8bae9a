// SPDX-License-Identifier: Apache-2.0
#include "python/arrays.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

namespace bodyloom::python {
namespace {

std::string ExpectedText(const std::vector<Extent>& shape) {
  std::string text = "(";
  for (const Extent& extent : shape) text += (text.size() > 1 ? ", " : "") + extent.name;
  return text + (shape.size() == 1 ? ",)" : ")");
}

std::string ShapeText(const py::array& array) { return py::str(py::tuple(array.attr("shape"))); }

std::string TypeText(const py::handle& value) { return py::str(py::type::handle_of(value).attr("__name__")); }

/// Converts the value by numpy.asarray(); raises TypeError when this fails.
py::array AsArray(const py::handle& value, const std::string& name, const std::string& expected) {
  try {
    return py::module_::import("numpy").attr("asarray")(value);
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    throw py::type_error(name + ": expected " + expected + ", found " + TypeText(value) + " that makes no array");
  }
}

void RequireShape(const py::array& array, const std::string& name, const std::string& what,
                  const std::vector<Extent>& shape) {
  bool fits = array.ndim() == py::ssize_t(shape.size());
  for (size_t i = 0; fits && i < shape.size(); ++i) {
    fits = shape[i].size < 0 || shape[i].size == array.shape(py::ssize_t(i));
  }
  if (!fits) {
    throw py::value_error(name + ": expected " + what + " of shape " + ExpectedText(shape) + ", found shape " +
                          ShapeText(array));
  }
}

void ForbidWriting(const py::array& array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
}

void SwapRedAndBlue(uint8_t* pixels, size_t count) {
  for (size_t i = 0; i < count; ++i) std::swap(pixels[3 * i], pixels[3 * i + 2]);
}

}  // namespace

template <typename T>
RowMajorArray<T> NumbersFrom(const py::handle& value, const char* name, const std::vector<Extent>& shape) {
  const std::string expected = "numbers of shape " + ExpectedText(shape);
  const py::array array = AsArray(value, name, expected);
  if (std::strchr("fiu", array.dtype().kind()) == nullptr) {
    const std::string found = py::isinstance<py::array>(value) ? py::str(array.dtype()) : py::str(TypeText(value));
    throw py::type_error(std::string(name) + ": expected " + expected + ", found " + found);
  }
  RequireShape(array, name, "numbers", shape);
  return RowMajorArray<T>(array);
}

Image ImageFrom(const py::handle& value, const char* name) {
  const std::vector<Extent> shape = {"H", "W", 3};
  const std::string expected = "uint8 of shape " + ExpectedText(shape) + " (red, green, blue)";
  const py::array array = AsArray(value, name, expected);
  if (!array.dtype().equal(py::dtype::of<uint8_t>())) {
    throw py::type_error(std::string(name) + ": expected " + expected + ", found " +
                         std::string(py::str(array.dtype())));
  }
  RequireShape(array, name, "uint8", shape);
  const RowMajorArray<uint8_t> pixels(array);
  Image image(int(array.shape(1)), int(array.shape(0)));
  std::copy_n(pixels.data(), image.bgr.size(), image.bgr.begin());
  SwapRedAndBlue(image.bgr.data(), image.bgr.size() / 3);
  return image;
}

template <typename T>
py::array View(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               const py::handle& owner) {
  py::array view(py::dtype::of<T>(), std::move(shape), std::move(strides), data, owner);
  ForbidWriting(view);
  return view;
}

template <typename T>
py::array View(const T* data, std::vector<py::ssize_t> shape, const py::handle& owner) {
  std::vector<py::ssize_t> strides = py::detail::c_strides(shape, sizeof(T));
  return View(data, std::move(shape), std::move(strides), owner);
}

template <typename T>
py::array ArrayOwning(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  T* data = kept->data();
  const py::capsule owner(kept.get(), [](void* memory) { delete static_cast<std::vector<T>*>(memory); });
  static_cast<void>(kept.release());  // the capsule owns it
  return py::array_t<T>(std::move(shape), data, owner);
}

py::array ArrayFromImage(Image image) {
  SwapRedAndBlue(image.bgr.data(), image.bgr.size() / 3);
  return ArrayOwning(std::move(image.bgr), {image.height, image.width, 3});
}

Eigen::VectorXd VectorFrom(const py::handle& value, const char* name, const Extent& size) {
  const RowMajorArray<double> numbers = NumbersFrom<double>(value, name, {size});
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), numbers.size());
}

template RowMajorArray<float> NumbersFrom(const py::handle&, const char*, const std::vector<Extent>&);
template RowMajorArray<double> NumbersFrom(const py::handle&, const char*, const std::vector<Extent>&);
template RowMajorArray<int> NumbersFrom(const py::handle&, const char*, const std::vector<Extent>&);
template py::array View(const float*, std::vector<py::ssize_t>, const py::handle&);
template py::array View(const double*, std::vector<py::ssize_t>, const py::handle&);
template py::array View(const int*, std::vector<py::ssize_t>, const py::handle&);
template py::array View(const uint8_t*, std::vector<py::ssize_t>, const py::handle&);
template py::array View(const double*, std::vector<py::ssize_t>, std::vector<py::ssize_t>, const py::handle&);
template py::array View(const float*, std::vector<py::ssize_t>, std::vector<py::ssize_t>, const py::handle&);
template py::array ArrayOwning(std::vector<double>, std::vector<py::ssize_t>);
template py::array ArrayOwning(std::vector<uint8_t>, std::vector<py::ssize_t>);

}  // namespace bodyloom::python
