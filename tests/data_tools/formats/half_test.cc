// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/ndarray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace bodyloom::half_test {
namespace {

// By the definition, for every number there is: (−1)^s · 2^(e − 15) · (1 + f / 1024), without the 1 for e = 0.
TEST(Half, EveryValue) {
  for (uint32_t bits = 0; bits < 65536; ++bits) {
    const auto exponent = static_cast<int>(bits >> 10 & 31), fraction = static_cast<int>(bits & 1023);
    const float value = FloatFromHalf(static_cast<uint16_t>(bits));
    if (exponent == 31 && fraction != 0) {
      EXPECT_TRUE(std::isnan(value)) << bits;
      continue;
    }
    double expected = std::ldexp((exponent == 0 ? 0 : 1) + fraction / 1024.0, std::max(exponent, 1) - 15);
    if (exponent == 31) expected = HUGE_VAL;
    if (bits >= 32768) expected = -expected;
    EXPECT_EQ(std::bit_cast<uint32_t>(value), std::bit_cast<uint32_t>(static_cast<float>(expected))) << bits;
  }
}

}  // namespace
}  // namespace bodyloom::half_test
