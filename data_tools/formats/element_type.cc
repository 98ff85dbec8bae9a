// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/element_type.h"

#include <algorithm>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kMaxStringWidth = size_t{1} << 24;

std::optional<DType> NumberType(char kind, size_t size) {
  struct Row {
    char kind;
    size_t size;
    DType dtype;
  };
  static constexpr Row kRows[] = {{'b', 1, DType::kBool}, {'i', 1, DType::kI8},  {'u', 1, DType::kU8},
                                  {'i', 2, DType::kI16},  {'u', 2, DType::kU16}, {'i', 4, DType::kI32},
                                  {'u', 4, DType::kU32},  {'i', 8, DType::kI64}, {'u', 8, DType::kU64},
                                  {'f', 2, DType::kF16},  {'f', 4, DType::kF32}, {'f', 8, DType::kF64}};
  for (const Row& row : kRows) {
    if (row.kind == kind && row.size == size) return row.dtype;
  }
  return std::nullopt;
}

/// Reverses the bytes of every unit of `unit` bytes (numbers: the element; UTF-32 text: 4).
void SwapBytes(size_t unit, std::string* bytes) {
  for (size_t i = 0; i + unit <= bytes->size(); i += unit) std::reverse(bytes->begin() + i, bytes->begin() + i + unit);
}

/// Fortran order (first index fastest) to C order (last index fastest).
std::string ReorderToC(const std::vector<int64_t>& shape, size_t item_size, std::string_view from) {
  std::string to(from.size(), '\0');
  std::vector<size_t> stride(shape.size(), item_size);  // bytes in `from` to step each index
  for (size_t d = 1; d < shape.size(); ++d) stride[d] = stride[d - 1] * static_cast<size_t>(shape[d - 1]);
  std::vector<int64_t> index(shape.size(), 0);
  size_t offset = 0;
  for (size_t out = 0; out < to.size(); out += item_size) {
    std::copy_n(from.data() + offset, item_size, to.data() + out);
    for (size_t d = shape.size(); d-- > 0;) {
      offset += stride[d];
      if (++index[d] < shape[d]) break;
      offset -= stride[d] * static_cast<size_t>(shape[d]);
      index[d] = 0;
    }
  }
  return to;
}

}  // namespace

std::optional<ElementType> ParseElementType(std::string_view descr) {
  ElementType type;
  if (!descr.empty() && (descr[0] == '<' || descr[0] == '>' || descr[0] == '|' || descr[0] == '=')) {
    type.big_endian = descr[0] == '>';
    descr.remove_prefix(1);
  }
  if (descr.size() < 2 || descr.size() > 9) return std::nullopt;
  const char kind = descr[0];
  size_t size = 0;
  for (const char c : descr.substr(1)) {
    if (c < '0' || c > '9') return std::nullopt;
    size = 10 * size + static_cast<size_t>(c - '0');
  }
  if (kind == 'S' || kind == 'a' || kind == 'U') {
    if (size > kMaxStringWidth) return std::nullopt;
    type.dtype = kind == 'U' ? DType::kUnicode : DType::kBytes;
    type.item_size = kind == 'U' ? 4 * size : size;
    return type;
  }
  const std::optional<DType> number = NumberType(kind, size);
  if (!number) return std::nullopt;
  type.dtype = *number;
  type.item_size = size;
  return type;
}

std::string ElementTypeText(const NdArray& array) {
  switch (array.dtype) {
    case DType::kBool:
      return "|b1";
    case DType::kI8:
      return "|i1";
    case DType::kU8:
      return "|u1";
    case DType::kI16:
      return "<i2";
    case DType::kU16:
      return "<u2";
    case DType::kI32:
      return "<i4";
    case DType::kU32:
      return "<u4";
    case DType::kI64:
      return "<i8";
    case DType::kU64:
      return "<u8";
    case DType::kF16:
      return "<f2";
    case DType::kF32:
      return "<f4";
    case DType::kF64:
      return "<f8";
    case DType::kBytes:
      return "|S" + std::to_string(array.item_size);
    case DType::kUnicode:
      return "<U" + std::to_string(array.item_size / 4);
    case DType::kBF16:
    case DType::kOther:
      break;
  }
  return "|O";
}

std::optional<size_t> ArrayBytes(const std::vector<int64_t>& shape, size_t item_size) {
  // Elements without bytes ("<U0") take no space in the file, so their number needs a separate bound.
  const size_t kMax = item_size == 0 ? size_t{1} << 20 : size_t{1} << 62;
  if (shape.size() > 32) return std::nullopt;
  size_t bytes = std::max<size_t>(item_size, 1);
  for (const int64_t n : shape) {
    if (n < 0) return std::nullopt;
    // The product is taken over max(n, 1), so that a zero dimension does not hide absurd others.
    const size_t factor = std::max<size_t>(static_cast<size_t>(n), 1);
    if (bytes > kMax / factor) return std::nullopt;
    bytes *= factor;
  }
  return item_size == 0 || std::find(shape.begin(), shape.end(), 0) != shape.end() ? size_t{0} : bytes;
}

NdArray ArrayFromBytes(const ElementType& type, std::vector<int64_t> shape, bool fortran_order,
                       std::string_view bytes) {
  const std::optional<size_t> expected = ArrayBytes(shape, type.item_size);
  BODYLOOM_CHECK(expected && *expected == bytes.size(), "array of ", bytes.size(), " bytes, its shape needs ",
                 expected ? std::to_string(*expected) : "more than fits");
  NdArray array;
  array.dtype = type.dtype;
  array.item_size = type.item_size;
  array.shape = std::move(shape);
  array.bytes = fortran_order && array.shape.size() > 1 && !bytes.empty()
                    ? ReorderToC(array.shape, type.item_size, bytes)
                    : std::string(bytes);
  // Bytes have no order, regardless of their type string.
  if (type.big_endian && type.dtype != DType::kBytes) {
    SwapBytes(type.dtype == DType::kUnicode ? 4 : type.item_size, &array.bytes);
  }
  return array;
}

}  // namespace bodyloom
