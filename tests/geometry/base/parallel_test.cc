// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "geometry/base/parallel.h"

namespace bodyloom::parallel_test {
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
  // So many that the others cannot be through before the exception is caught, however long that takes.
  constexpr int kCount = 1'000'000'000;
  for (int threads : {1, 4}) {
    std::atomic<int> calls{0};
    try {
      ParallelFor(kCount, threads, [&](int i) {
        ++calls;
        if (i == 10) throw std::runtime_error("index ten");
      });
      FAIL();
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(std::string(e.what()), "index ten");
    }
    EXPECT_LT(calls, kCount);
  }
}

TEST(ParallelFor, CallsMayBeNested) {
  std::vector<int> calls(20 * 30, 0);
  ParallelFor(20, 4, [&](int i) { ParallelFor(30, 3, [&](int j) { ++calls[30 * i + j]; }); });
  EXPECT_EQ(calls, std::vector<int>(calls.size(), 1));
}

TEST(ParallelFor, CallsMayComeFromSeveralThreadsAtOnce) {
  constexpr int kCallers = 6, kLoops = 2000, kCount = 5;
  std::vector<int> calls(kCallers * kCount, 0);
  {
    std::vector<std::jthread> callers;
    callers.reserve(kCallers);
    for (int c = 0; c < kCallers; ++c) {
      callers.emplace_back([&, c] {
        for (int k = 0; k < kLoops; ++k) ParallelFor(kCount, 3, [&](int i) { ++calls[c * kCount + i]; });
      });
    }
  }
  EXPECT_EQ(calls, std::vector<int>(calls.size(), kLoops));
}

TEST(ParallelFor, AThreadThatSleepsIsWokenOrDoneWithout) {
  for (int k = 0; k < 20; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // longer than a kept thread waits awake
    std::vector<int> calls(3, 0);
    ParallelFor(3, 3, [&](int i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(3, 1));
  }
}

TEST(ParallelFor, WorksInAForkedProcess) {
  ParallelFor(4, 4, [](int) {});  // kept threads exist, and stay behind
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::atomic<int> sum{0};
    ParallelFor(100, 4, [&](int i) { sum += i; });
    _exit(sum == 4950 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

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

}  // namespace bodyloom::parallel_test
