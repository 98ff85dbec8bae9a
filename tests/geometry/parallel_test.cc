// SPDX-License-Identifier: Apache-2.0
#include "geometry/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace bodyloom {
namespace {

TEST(ParallelFor, EveryIndexOnce) {
  for (int threads : {-1, 0, 1, 2, 3, 16}) {
    for (int count : {0, 1, 2, 7, 1000}) {
      std::vector<int> calls(count, 0);
      ParallelFor(count, threads, [&](int i) { ++calls[i]; });
      EXPECT_EQ(calls, std::vector<int>(count, 1)) << threads << " threads, " << count;
    }
  }
}

TEST(ParallelFor, UsesSeveralThreads) {
  std::mutex mutex;
  std::set<std::thread::id> ids;
  std::atomic<int> arrived{0};
  ParallelFor(2, 2, [&](int) {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      ids.insert(std::this_thread::get_id());
    }
    ++arrived;
    while (arrived < 2) std::this_thread::yield();  // neither index can finish before both have begun
  });
  EXPECT_EQ(ids.size(), 2u);
  EXPECT_EQ(ids.count(std::this_thread::get_id()), 1u);
}

TEST(ParallelFor, AnExceptionReachesTheCaller) {
  for (int threads : {1, 4}) {
    std::atomic<int> calls{0};
    try {
      ParallelFor(100000, threads, [&](int i) {
        ++calls;
        if (i == 10) throw std::runtime_error("index ten");
      });
      FAIL();
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(std::string(e.what()), "index ten");
    }
    EXPECT_LT(calls, 100000);
  }
}

}  // namespace
}  // namespace bodyloom
