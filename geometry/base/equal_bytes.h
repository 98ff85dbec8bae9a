// SPDX-License-Identifier: Apache-2.0
/// Runs of equal bytes and differences between rows of bytes, eight at a time: label images are large and mostly
/// constant.
#pragma once

#include <cstdint>
#include <cstring>

namespace bodyloom {

/// Eight bytes as one number.
inline uint64_t EightBytes(const uint8_t* bytes) {
  uint64_t word;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

/// End of the run of bytes equal to row[begin]: the first i > begin with row[i] ≠ row[begin], or `end`.
/// Requires begin < end.
inline int EndOfRun(const uint8_t* row, int begin, int end) {
  const uint8_t value = row[begin];
  const uint64_t all = value * 0x0101010101010101U;
  int i = begin + 1;
  while (i + 8 <= end && EightBytes(row + i) == all) i += 8;
  while (i < end && row[i] == value) ++i;
  return i;
}

/// The first i in begin..end−1 at which one of the other rows differs from `row`, or `end`. All are valid up to `end`.
template <typename... Rows>
int FirstDifference(int begin, int end, const uint8_t* row, const Rows*... others) {
  int i = begin;
  while (i + 8 <= end && ((EightBytes(row + i) == EightBytes(others + i)) && ...)) i += 8;
  while (i < end && ((row[i] == others[i]) && ...)) ++i;
  return i;
}

}  // namespace bodyloom
