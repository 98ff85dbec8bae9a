// SPDX-License-Identifier: Apache-2.0
#include "geometry/base/equal_bytes.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace bodyloom::equal_bytes_test {
namespace {

/// Bytes in runs of 1 to 40.
std::vector<uint8_t> RowOfRuns(int size, std::mt19937* random) {
  std::vector<uint8_t> row;
  while (int(row.size()) < size) {
    const auto length = std::uniform_int_distribution<size_t>(1, 40)(*random);
    const auto value = std::uniform_int_distribution<int>(0, 2)(*random);
    row.insert(row.end(), length, uint8_t(value * 100));
  }
  row.resize(size_t(size));
  return row;
}

TEST(EqualBytes, RunsEndWhereTheNextByteDiffers) {
  std::mt19937 random(1);
  for (const int size : {1, 7, 8, 9, 64, 301}) {
    const std::vector<uint8_t> row = RowOfRuns(size, &random);
    for (int begin = 0; begin < size; ++begin) {
      int end = begin;
      while (end < size && row[size_t(end)] == row[size_t(begin)]) ++end;
      ASSERT_EQ(EndOfRun(row.data(), begin, size), end) << begin << " of " << size;
    }
  }
}

TEST(EqualBytes, DifferencesAreFoundInAnyRow) {
  std::mt19937 random(2);
  for (const int size : {1, 7, 8, 9, 64, 301}) {
    const std::vector<uint8_t> row = RowOfRuns(size, &random);
    std::vector<uint8_t> second = row, third = row;
    ASSERT_EQ(FirstDifference(0, size, row.data(), second.data(), third.data()), size);
    for (int at = 0; at < size; ++at) {
      std::vector<uint8_t>& changed = at % 2 == 0 ? second : third;
      ++changed[size_t(at)];
      for (int begin = 0; begin < size; ++begin) {
        ASSERT_EQ(FirstDifference(begin, size, row.data(), second.data(), third.data()), begin <= at ? at : size);
      }
      --changed[size_t(at)];
    }
  }
}

}  // namespace
}  // namespace bodyloom::equal_bytes_test
