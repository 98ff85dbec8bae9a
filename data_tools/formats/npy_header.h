// SPDX-License-Identifier: Apache-2.0
/// The header of a .npy file. Source: numpy/lib/format.py.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data_tools/formats/element_type.h"

namespace bodyloom {

/// Upper bound of the size of accepted headers, magic and version included.
inline constexpr size_t kMaxNpyHeaderBytes = (size_t{1} << 16) + 12;

struct NpyHeader {
  std::string descr;                ///< numpy's description of an element
  std::optional<ElementType> type;  ///< nullopt: neither numbers nor text
  bool fortran_order = false;
  std::vector<int64_t> shape;
  size_t data_begin = 0;  ///< offset of the values in bytes
};

/// Parses the header of a file of `file_bytes` bytes that begins with `head`: the whole file, or at least
/// kMaxNpyHeaderBytes of it. Throws std::runtime_error "where: why" for an invalid header, one longer than 64 KiB, or
/// one whose number of values (of numbers or text) does not match the size of the file.
NpyHeader ParseNpyHeader(std::string_view head, size_t file_bytes, const std::string& where);

/// Header in the form that ParseNpyHeader reads, padded so that the values begin at a multiple of 64 bytes. Throws
/// std::invalid_argument for arrays of kOther or kBF16 and of rank above some 32.
std::string NpyHeaderText(const NdArray& array);

}  // namespace bodyloom
