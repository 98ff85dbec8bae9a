// SPDX-License-Identifier: Apache-2.0
/// Hands items from one thread to another with bounded memory: when the reader is slow, the oldest items are dropped,
/// or the writer waits.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace bodyloom {

enum class WhenFull { kDropOldest, kWait };

template <class Item>
class Mailbox {
 public:
  /// Holds at most `depth` items, at least 1.
  explicit Mailbox(size_t depth, WhenFull when_full = WhenFull::kDropOldest)
      : depth_(depth > 0 ? depth : 1), when_full_(when_full) {}
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  /// Adds an item. A full mailbox drops its oldest one, or waits until one is taken. Returns false, and adds nothing,
  /// once it is closed.
  bool Put(Item item) {
    std::unique_lock lock(mutex_);
    if (when_full_ == WhenFull::kWait) {
      changed_.wait(lock, [this] { return closed_ || items_.size() < depth_; });
    }
    if (closed_) return false;
    if (items_.size() == depth_) {
      items_.pop_front();
      ++num_dropped_;
    }
    items_.push_back(std::move(item));
    changed_.notify_all();
    return true;
  }

  /// Takes the oldest item, waiting for one; nothing once the mailbox is closed and empty.
  std::optional<Item> Take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || !items_.empty(); });
    if (items_.empty()) return std::nullopt;
    std::optional<Item> item(std::move(items_.front()));
    items_.pop_front();
    changed_.notify_all();
    return item;
  }

  /// Ends it: whoever waits goes on. Items inside can still be taken.
  void Close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

  [[nodiscard]] int64_t num_dropped() const {
    const std::lock_guard lock(mutex_);
    return num_dropped_;
  }

 private:
  const size_t depth_;
  const WhenFull when_full_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> items_;
  bool closed_ = false;
  int64_t num_dropped_ = 0;
};

}  // namespace bodyloom
