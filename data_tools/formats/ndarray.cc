// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/ndarray.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// The sixteen bits are the upper ones of a float.
float FloatFromBrain(uint16_t brain) { return std::bit_cast<float>(static_cast<uint32_t>(brain) << 16); }

/// Calls use(index, value) for every element of type T; the bytes of a std::string need not be aligned for T.
template <typename T, typename Use>
void ForEachOf(const NdArray& array, const Use& use) {
  const size_t n = array.bytes.size() / sizeof(T);
  for (size_t i = 0; i < n; ++i) {
    T value;
    std::memcpy(&value, array.bytes.data() + i * sizeof(T), sizeof(T));
    use(i, value);
  }
}

template <typename Use>
void ForEachNumber(const NdArray& array, const Use& use) {
  switch (array.dtype) {
    case DType::kBool:
      return ForEachOf<uint8_t>(array, [&](size_t i, uint8_t x) { use(i, static_cast<uint8_t>(x != 0)); });
    case DType::kI8:
      return ForEachOf<int8_t>(array, use);
    case DType::kU8:
      return ForEachOf<uint8_t>(array, use);
    case DType::kI16:
      return ForEachOf<int16_t>(array, use);
    case DType::kU16:
      return ForEachOf<uint16_t>(array, use);
    case DType::kI32:
      return ForEachOf<int32_t>(array, use);
    case DType::kU32:
      return ForEachOf<uint32_t>(array, use);
    case DType::kI64:
      return ForEachOf<int64_t>(array, use);
    case DType::kU64:
      return ForEachOf<uint64_t>(array, use);
    case DType::kF16:
      return ForEachOf<uint16_t>(array, [&](size_t i, uint16_t x) { use(i, FloatFromHalf(x)); });
    case DType::kBF16:
      return ForEachOf<uint16_t>(array, [&](size_t i, uint16_t x) { use(i, FloatFromBrain(x)); });
    case DType::kF32:
      return ForEachOf<float>(array, use);
    case DType::kF64:
      return ForEachOf<double>(array, use);
    case DType::kBytes:
    case DType::kUnicode:
    case DType::kOther:
      break;
  }
  BODYLOOM_CHECK(false, array.is_text() ? "an array of text was found" : "an array of objects was found",
                 ", expected numbers");
}

template <typename T>
std::vector<T> Convert(const NdArray& array) {
  std::vector<T> result(static_cast<size_t>(array.num_elements()));
  ForEachNumber(array, [&](size_t i, auto x) { result[i] = static_cast<T>(x); });
  return result;
}

template <typename T>
NdArray FromNumbers(DType dtype, const T* values, std::vector<int64_t> shape) {
  NdArray array;
  array.dtype = dtype;
  array.item_size = sizeof(T);
  array.shape = std::move(shape);
  array.bytes.assign(reinterpret_cast<const char*>(values), static_cast<size_t>(array.num_elements()) * sizeof(T));
  return array;
}

NdArray TextArray(const std::vector<std::string>& values, std::vector<int64_t> shape) {
  std::vector<std::vector<uint32_t>> codes;
  size_t width = 1;
  for (const std::string& value : values) {
    codes.push_back(CodePoints(value));
    width = std::max(width, codes.back().size());
  }
  NdArray array;
  array.dtype = DType::kUnicode;
  array.item_size = 4 * width;
  array.shape = std::move(shape);
  array.bytes.assign(values.size() * array.item_size, '\0');
  for (size_t i = 0; i < codes.size(); ++i) {
    if (codes[i].empty()) continue;
    std::memcpy(array.bytes.data() + i * array.item_size, codes[i].data(), 4 * codes[i].size());
  }
  return array;
}

}  // namespace

int64_t NdArray::num_elements() const {
  int64_t n = 1;
  for (const int64_t d : shape) n *= d;
  return n;
}

std::string NdArray::ShapeText() const {
  if (shape.empty()) return "scalar";
  std::string text;
  for (size_t d = 0; d < shape.size(); ++d) text += (d == 0 ? "" : "x") + std::to_string(shape[d]);
  return text;
}

std::vector<double> NdArray::ToDoubles() const { return Convert<double>(*this); }

std::vector<float> NdArray::ToFloats() const { return Convert<float>(*this); }

std::vector<int64_t> NdArray::ToInts() const {
  std::vector<int64_t> result(static_cast<size_t>(num_elements()));
  ForEachNumber(*this, [&](size_t i, auto x) {
    if constexpr (std::is_floating_point_v<decltype(x)>) {
      BODYLOOM_CHECK(x == std::floor(x) && std::abs(static_cast<double>(x)) < 9e18, "element ", i, " is ", x,
                     ", expected a whole number");
    } else if constexpr (std::is_same_v<decltype(x), uint64_t>) {
      BODYLOOM_CHECK(x <= static_cast<uint64_t>(std::numeric_limits<int64_t>::max()), "element ", i, " is ", x,
                     ", expected a number below 2^63");
    }
    result[i] = static_cast<int64_t>(x);  // NOLINT(bugprone-signed-char-misuse): int8 is a number here
  });
  return result;
}

std::vector<std::string> NdArray::ToStrings() const {
  BODYLOOM_CHECK(is_text(), "an array of ", is_number() ? "numbers" : "objects", " was found, expected text");
  std::vector<std::string> result(static_cast<size_t>(num_elements()));
  for (size_t i = 0; i < result.size(); ++i) {
    const char* element = bytes.data() + i * item_size;
    if (dtype == DType::kBytes) {
      result[i].assign(element, item_size);
      result[i].erase(result[i].find_last_not_of('\0') + 1);
      continue;
    }
    std::vector<uint32_t> codes(item_size / 4);
    if (!codes.empty()) std::memcpy(codes.data(), element, item_size);
    while (!codes.empty() && codes.back() == 0) codes.pop_back();
    for (const uint32_t code : codes) AppendUtf8(code, &result[i]);
  }
  return result;
}

RowMatrixXd NdArray::ToMatrix() const {
  const int64_t rows = shape.empty() ? 1 : shape[0];
  int64_t columns = 1;
  for (size_t d = 1; d < shape.size(); ++d) columns *= shape[d];
  RowMatrixXd matrix(rows, columns);
  ForEachNumber(*this, [&](size_t i, auto x) { matrix.data()[i] = static_cast<double>(x); });
  return matrix;
}

NdArray NdArray::FromDoubles(const double* values, std::vector<int64_t> shape) {
  return FromNumbers(DType::kF64, values, std::move(shape));
}

NdArray NdArray::FromFloats(const float* values, std::vector<int64_t> shape) {
  return FromNumbers(DType::kF32, values, std::move(shape));
}

NdArray NdArray::FromInts32(const int32_t* values, std::vector<int64_t> shape) {
  return FromNumbers(DType::kI32, values, std::move(shape));
}

NdArray NdArray::FromUInt8(const uint8_t* values, std::vector<int64_t> shape) {
  return FromNumbers(DType::kU8, values, std::move(shape));
}

NdArray NdArray::FromStrings(const std::vector<std::string>& values) {
  return TextArray(values, {static_cast<int64_t>(values.size())});
}

NdArray NdArray::FromString(const std::string& value) { return TextArray({value}, {}); }

NdArray NdArray::FromDouble(double value) { return FromDoubles(&value, {}); }

std::vector<int64_t> WholeNumbers(const NdArray& array, const std::string& name, const std::string& where) {
  try {
    return array.ToInts();
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(where + ": " + name + ": " + error.what());
  }
}

}  // namespace bodyloom
