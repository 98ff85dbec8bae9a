// SPDX-License-Identifier: Apache-2.0
/// Runs work with every instruction set of the machine and several numbers of threads and compares the tables bit for
/// bit.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "render/raster/raster_simd.h"
#include "render/splat/float_columns.h"

namespace bodyloom {

inline bool SameBytes(const FloatColumns& a, const FloatColumns& b) {
  if (a.rows() != b.rows() || a.columns() != b.columns()) return false;
  for (int c = 0; c < a.columns(); ++c) {
    if (a.rows() > 0 && std::memcmp(a.column(c), b.column(c), sizeof(float) * a.rows()) != 0) return false;
  }
  return true;
}

/// `work(threads, table)` must fill the same table every time.
inline void ExpectSameBytesEverywhere(const std::function<void(int, FloatColumns*)>& work) {
  FloatColumns first;
  work(1, &first);
  ASSERT_GT(first.rows(), 0);
  int compared = 0;
  for (const int64_t target : raster_internal::SimdTargets()) {
    raster_internal::ForceSimdTarget(target);
    for (const int threads : {1, 2, 5}) {
      FloatColumns other;
      work(threads, &other);
      EXPECT_TRUE(SameBytes(first, other)) << raster_internal::SimdTargetName(target) << ", " << threads << " threads";
      ++compared;
    }
  }
  raster_internal::ForceSimdTarget(0);
  EXPECT_GE(compared, 3);
}

}  // namespace bodyloom
