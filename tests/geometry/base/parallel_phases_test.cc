// SPDX-License-Identifier: Apache-2.0
#include "geometry/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace bodyloom::parallel_phases_test {
namespace {

TEST(ParallelPhases, APhaseSeesAllOfTheOneBefore) {
  for (const int threads : {1, 2, 7}) {
    for (int repetition = 0; repetition < 50; ++repetition) {
      std::vector<int> first(100, 0), second;
      std::atomic<int> wrong{0}, ran{0};
      RunPhases(threads, {{[] { return 100; }, [&](int i) { first[i] = i + 1; }},
                          {[] { return 0; }, [&](int) { ++wrong; }},
                          {[&] {
                             for (int i = 0; i < 100; ++i) wrong += first[i] != i + 1;
                             second.assign(40, 0);
                             return 40;
                           },
                           [&](int i) { second[i] = first[2 * i]; }},
                          {[] { return 40; },
                           [&](int i) {
                             wrong += second[39 - i] != 2 * (39 - i) + 1;
                             ++ran;
                           }},
                          {[] { return 0; }, [&](int) { ++wrong; }}});
      ASSERT_EQ(wrong, 0);
      ASSERT_EQ(ran, 40);
    }
  }
}

TEST(ParallelPhases, AnExceptionEndsThemAll) {
  for (const int threads : {1, 2, 7}) {
    std::atomic<int> later{0};
    const std::vector<Phase> in_a_task = {{[] { return 50; },
                                           [](int i) {
                                             if (i == 20) throw std::runtime_error("task");
                                           }},
                                          {[] { return 5; }, [&](int) { ++later; }}};
    EXPECT_THROW(RunPhases(threads, in_a_task), std::runtime_error);
    const std::vector<Phase> in_a_count = {{[] { return 50; }, [](int) {}},
                                           {[]() -> int { throw std::runtime_error("count"); }, [&](int) { ++later; }},
                                           {[] { return 5; }, [&](int) { ++later; }}};
    EXPECT_THROW(RunPhases(threads, in_a_count), std::runtime_error);
    EXPECT_EQ(later, 0);
  }
}

}  // namespace
}  // namespace bodyloom::parallel_phases_test
