// SPDX-License-Identifier: Apache-2.0
/// A typed n-dimensional array of .npy, .npz and pickle files: C order, little endian, owned bytes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// kOther: anything else (pickled objects, structures, complex numbers, dates), kept without its contents, so that the
/// other arrays of a file can be read; `bytes` holds numpy's description of the type.
/// kBF16 (the upper half of a float) occurs in network weights and not in numpy's files.
enum class DType {
  kBool,
  kI8,
  kU8,
  kI16,
  kU16,
  kI32,
  kU32,
  kI64,
  kU64,
  kF16,
  kBF16,
  kF32,
  kF64,
  kBytes,
  kUnicode,
  kOther
};

struct NdArray {
  DType dtype = DType::kF64;
  std::vector<int64_t> shape;  ///< empty: a scalar
  size_t item_size = 8;        ///< bytes per element (strings: width of an element)
  std::string bytes;           ///< C order

  [[nodiscard]] int64_t num_elements() const;
  [[nodiscard]] std::string ShapeText() const;  ///< "576x72", "scalar"
  [[nodiscard]] bool is_text() const { return dtype == DType::kBytes || dtype == DType::kUnicode; }
  [[nodiscard]] bool is_number() const { return !is_text() && dtype != DType::kOther; }
  /// All elements converted; throws std::invalid_argument for arrays that do not hold numbers.
  [[nodiscard]] std::vector<double> ToDoubles() const;
  [[nodiscard]] std::vector<float> ToFloats() const;
  /// Elements of an integer or boolean array (floats only when integral); throws otherwise.
  [[nodiscard]] std::vector<int64_t> ToInts() const;
  /// Text elements of kBytes/kUnicode arrays (trailing NULs stripped, UTF-8).
  [[nodiscard]] std::vector<std::string> ToStrings() const;
  /// Rows×rest matrix: the first dimension is the row, the others are flattened (a scalar or vector gives n×1).
  [[nodiscard]] RowMatrixXd ToMatrix() const;

  static NdArray FromDoubles(const double* values, std::vector<int64_t> shape);
  static NdArray FromFloats(const float* values, std::vector<int64_t> shape);
  static NdArray FromInts32(const int32_t* values, std::vector<int64_t> shape);
  static NdArray FromUInt8(const uint8_t* values, std::vector<int64_t> shape);
  static NdArray FromStrings(const std::vector<std::string>& values);
  static NdArray FromString(const std::string& value);  ///< scalar '<U'
  static NdArray FromDouble(double value);              ///< scalar
};

// IEEE half precision, as in .npy files and descriptors.

/// The value of 16 bits; exact. Subnormal numbers, infinities and NaN included.
inline float FloatFromHalf(uint16_t half) {
  const int exponent = (half >> 10) & 31;
  const int fraction = half & 1023;
  float value = 0;
  if (exponent == 31) {
    value = fraction == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  } else if (exponent == 0) {
    value = static_cast<float>(fraction) * 0x1p-24F;
  } else {  // the same bits with another bias; fast, as network weights come by the million
    value = std::bit_cast<float>(static_cast<uint32_t>((exponent + 112) << 23 | fraction << 13));
  }
  return (half & 0x8000) != 0 ? -value : value;
}

// Arrays of indices from files.

/// Returns the integers of the array called `name`; throws std::runtime_error naming `where`, the array and the element
/// if it holds anything else.
std::vector<int64_t> WholeNumbers(const NdArray& array, const std::string& name, const std::string& where);

}  // namespace bodyloom
