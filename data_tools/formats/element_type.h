// SPDX-License-Identifier: Apache-2.0
/// numpy's element type strings ("<f8", "|u1", ">i4", "<U12") and arrays made from foreign bytes.
/// Source: numpy, "The array interface protocol" (typestr).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data_tools/formats/ndarray.h"

namespace bodyloom {

struct ElementType {
  DType dtype = DType::kF64;
  size_t item_size = 8;  ///< bytes; strings: the whole element ("<U12": 48)
  bool big_endian = false;
};

/// Nullopt for types that are not plain numbers or strings (objects, structures, complex, dates, 128-bit floats). A
/// missing byte order means little endian.
std::optional<ElementType> ParseElementType(std::string_view descr);

/// The little-endian type string of an array's elements.
std::string ElementTypeText(const NdArray& array);

/// Size of an array of this shape in bytes; nullopt when a dimension is negative, the rank exceeds 32 (numpy's limit),
/// or the product overflows.
std::optional<size_t> ArrayBytes(const std::vector<int64_t>& shape, size_t item_size);

/// Copies `bytes` (exactly ArrayBytes long, else std::invalid_argument) into C order and little endian.
NdArray ArrayFromBytes(const ElementType& type, std::vector<int64_t> shape, bool fortran_order, std::string_view bytes);

}  // namespace bodyloom
