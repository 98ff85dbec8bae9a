// SPDX-License-Identifier: Apache-2.0
#include "pipelines/files.h"

#include <gtest/gtest.h>

namespace bodyloom::peak_memory_test {
namespace {

TEST(PeakMemory, IsThatOfAProcess) {
  EXPECT_GT(PeakMemoryBytes(), size_t{1} << 20);
  EXPECT_LT(PeakMemoryBytes(), size_t{1} << 36);
}

}  // namespace
}  // namespace bodyloom::peak_memory_test
