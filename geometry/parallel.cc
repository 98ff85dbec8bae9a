// SPDX-License-Identifier: Apache-2.0
#include "geometry/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace bodyloom {

void ParallelFor(int count, int num_threads, const std::function<void(int)>& body) {
  if (num_threads <= 1 || count <= 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  std::atomic<int> next{0};
  std::mutex mutex;
  std::exception_ptr first_error;
  const auto work = [&] {
    for (int i = next.fetch_add(1); i < count; i = next.fetch_add(1)) {
      try {
        body(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!first_error) first_error = std::current_exception();
        next.store(count);
      }
    }
  };
  std::vector<std::jthread> threads;
  threads.reserve(num_threads);
  try {
    while (static_cast<int>(threads.size()) + 1 < std::min(num_threads, count)) threads.emplace_back(work);
  } catch (const std::system_error&) {
    // The system has no more threads to give: those that started, and this one, do the work.
  }
  work();
  threads.clear();  // joins
  if (first_error) std::rethrow_exception(first_error);
}

}  // namespace bodyloom
