// SPDX-License-Identifier: Apache-2.0
/// Computes items ahead of their request on a separate thread: batches of a training run, frames of a video.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "geometry/base/stopwatch.h"

namespace bodyloom {

template <class Item>
class Prefetcher {
 public:
  /// `make` is called `count` times, one call after the other, with 0, 1, … count − 1, on the other thread; at most
  /// `depth` results wait.
  Prefetcher(int64_t count, std::function<Item(int64_t)> make, size_t depth = 3)
      : make_(std::move(make)), depth_(depth), thread_([this, count] { Run(count); }) {}
  ~Prefetcher() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Prefetcher(const Prefetcher&) = delete;
  Prefetcher& operator=(const Prefetcher&) = delete;

  /// Returns the next item, waiting for it if necessary; at most `count` times. Rethrows the exception of `make` after
  /// all items made before it were taken. Adds the waiting time to waited_s().
  Item Take() {
    const Stopwatch watch;
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !ready_.empty() || error_ != nullptr; });
    waited_s_ += watch.seconds();
    if (ready_.empty()) std::rethrow_exception(error_);
    Item item = std::move(ready_.front());
    ready_.pop_front();
    changed_.notify_all();
    return item;
  }
  [[nodiscard]] double waited_s() const { return waited_s_; }

 private:
  void Run(int64_t count) {
    try {
      for (int64_t i = 0; i < count; ++i) {
        Item item = make_(i);
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return stop_ || ready_.size() < depth_; });
        if (stop_) return;
        ready_.push_back(std::move(item));
        changed_.notify_all();
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      changed_.notify_all();
    }
  }

  std::function<Item(int64_t)> make_;
  size_t depth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> ready_;
  std::exception_ptr error_;
  bool stop_ = false;
  double waited_s_ = 0;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace bodyloom
