// SPDX-License-Identifier: Apache-2.0
#include "geometry/base/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace bodyloom {
namespace {

/// One call of ParallelFor, on its caller's stack.
class Loop {
 public:
  Loop(int count, const std::function<void(int)>& body) : count_(count), body_(body) {}

  void Work() {
    for (int i = next_.fetch_add(1); i < count_; i = next_.fetch_add(1)) {
      try {
        body_(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!first_error_) first_error_ = std::current_exception();
        next_.store(count_);
      }
    }
  }
  void Rethrow() const {
    if (first_error_) std::rethrow_exception(first_error_);
  }

 private:
  const int count_;
  const std::function<void(int)>& body_;
  std::atomic<int> next_{0};
  std::mutex mutex_;
  std::exception_ptr first_error_;
};

/// A kept thread. It helps with one loop after the other, each in four phases: free, claimed, offered (the loop is
/// there to be taken), at work. A loop's caller may withdraw an offer that was not taken yet, so no call waits for a
/// thread that wakes late, or that a fork() has left behind.
class Helper {
 public:
  /// Offers the loop; false when the helper is not free. `turn` says which of the helper's loops this is.
  bool Offer(Loop* loop, uint64_t* turn) {
    uint64_t state = state_.load();
    if (state % 4 != kFree || !state_.compare_exchange_strong(state, state + kClaimed)) return false;
    *turn = state / 4;
    loop_ = loop;
    state_.store(state + kOffered);
    state_.notify_all();
    return true;
  }
  /// Returns when the helper has nothing to do with that loop any more.
  void End(uint64_t turn) {
    uint64_t offered = 4 * turn + kOffered;
    if (state_.compare_exchange_strong(offered, 4 * (turn + 1))) return;
    Await([turn](uint64_t state) { return state / 4 != turn; });
  }

  [[noreturn]] void Run() {
    for (;;) {
      uint64_t state = Await([](uint64_t s) { return s % 4 == kOffered; });
      if (!state_.compare_exchange_strong(state, state / 4 * 4 + kAtWork)) continue;
      loop_->Work();
      state_.store(4 * (state / 4 + 1));
      state_.notify_all();
    }
  }

 private:
  enum : uint64_t { kFree, kClaimed, kOffered, kAtWork };

  /// The first state that `is_it` holds for. A solver's loops follow one another within microseconds; asleep, a thread
  /// would need longer than that to wake.
  template <typename Condition>
  uint64_t Await(const Condition& is_it) const {
    constexpr std::chrono::microseconds kPatience{50};
    const auto begin = std::chrono::steady_clock::now();
    for (;;) {
      const uint64_t state = state_.load();
      if (is_it(state)) return state;
      if (std::chrono::steady_clock::now() - begin > kPatience) {
        state_.wait(state);
      } else {
        std::this_thread::yield();
      }
    }
  }

  std::atomic<uint64_t> state_{kFree};  ///< phase + 4 × turn
  Loop* loop_ = nullptr;
};

/// All helpers of the process. Never destroyed: a helper may be asleep in it until the process ends.
class Helpers {
 public:
  static Helpers& Get() {
    static Helpers* const helpers = new Helpers;
    return *helpers;
  }
  /// A helper that has been offered the loop, a new one where all are busy; null when there can be no more.
  Helper* Find(Loop* loop, uint64_t* turn) {
    for (int i = 0;; ++i) {
      if (i >= count_.load() && !Grow(i)) return nullptr;
      if (helpers_[i]->Offer(loop, turn)) return helpers_[i];
    }
  }

 private:
  /// Makes helper i unless another thread has.
  bool Grow(int i) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (i < count_.load()) return true;
    if (i == static_cast<int>(helpers_.size())) return false;
    auto* helper = new Helper;
    try {
      std::thread([helper] { helper->Run(); }).detach();
    } catch (const std::system_error&) {
      delete helper;  // the system has no more threads to give
      return false;
    }
    helpers_[i] = helper;
    count_.store(i + 1);
    return true;
  }

  std::mutex mutex_;
  std::atomic<int> count_{0};
  std::array<Helper*, 256> helpers_{};
};

}  // namespace

int ThreadsFor(int requested) {
  return requested > 0 ? requested : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void ParallelFor(int count, int num_threads, const std::function<void(int)>& body) {
  if (num_threads <= 1 || count <= 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  struct Help {
    Helper* helper;
    uint64_t turn;
  };
  Loop loop(count, body);
  std::vector<Help> help;
  help.reserve(std::min(num_threads, count) - 1);
  while (help.size() + 1 < static_cast<size_t>(std::min(num_threads, count))) {
    Help next{};
    next.helper = Helpers::Get().Find(&loop, &next.turn);
    if (next.helper == nullptr) break;
    help.push_back(next);
  }
  loop.Work();
  for (const Help& one : help) one.helper->End(one.turn);
  loop.Rethrow();
}

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
      // Threads that hold a task of the phase before are running, so this wait ends.
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
