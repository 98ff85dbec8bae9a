// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/parallel_phases.h"

#include <atomic>
#include <deque>
#include <thread>

#include "bodyloom/geometry/base/parallel.h"

namespace bodyloom {
namespace {

struct Progress {
  std::atomic<int> count{-1};  ///< −1: the phase before is not done
  std::atomic<int> next{0}, done{0};
};

}  // namespace

void RunPhases(int num_threads, const std::vector<Phase>& phases) {
  if (num_threads <= 1) {
    for (const Phase& phase : phases) {
      const int count = phase.count();
      for (int i = 0; i < count; ++i) phase.task(i);
    }
    return;
  }
  std::deque<Progress> progress(phases.size());
  std::atomic<bool> failed{false};
  // Opens phase p, and those after it as long as they have nothing to do.
  const auto open = [&](size_t p) {
    for (; p < phases.size(); ++p) {
      const int count = phases[p].count();
      progress[p].count.store(count, std::memory_order_release);
      if (count > 0) return;
    }
  };
  const auto work = [&] {
    for (size_t p = 0; p < phases.size(); ++p) {
      Progress& state = progress[p];
      // Whoever holds a task of the phase before is running, so this wait ends.
      while (state.count.load(std::memory_order_acquire) < 0) {
        if (failed) return;
        std::this_thread::yield();
      }
      const int count = state.count;
      for (int i = state.next.fetch_add(1); i < count; i = state.next.fetch_add(1)) {
        if (failed) return;
        phases[p].task(i);
        if (state.done.fetch_add(1, std::memory_order_acq_rel) + 1 == count) open(p + 1);
      }
    }
  };
  open(0);
  ParallelFor(num_threads, num_threads, [&](int) {
    try {
      work();
    } catch (...) {
      failed = true;
      throw;
    }
  });
}

}  // namespace bodyloom
