// SPDX-License-Identifier: Apache-2.0
#include "geometry/base/percentile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace bodyloom::percentile_test {
namespace {

TEST(Percentile, InterpolatesLikeNumpy) {
  const std::vector<double> values = {4, 1, NAN, 3, 2};
  EXPECT_DOUBLE_EQ(Percentile(values, 50), 2.5);
  EXPECT_DOUBLE_EQ(Percentile(values, 95), 3.85);  // numpy.percentile([1, 2, 3, 4], 95)
  EXPECT_DOUBLE_EQ(Percentile(values, 0), 1);
  EXPECT_DOUBLE_EQ(Percentile(values, 100), 4);
  EXPECT_TRUE(std::isnan(Percentile(std::vector<double>{}, 50)));
  EXPECT_THROW(Percentile(values, 101), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::percentile_test
