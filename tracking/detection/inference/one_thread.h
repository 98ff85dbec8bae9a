// SPDX-License-Identifier: Apache-2.0
/// oneDNN on the calling thread alone.
#pragma once

#include <omp.h>

namespace bodyloom {

/// oneDNN cuts its work for as many threads as OpenMP would give this thread, when a primitive is made and when it
/// runs. While one of these lives that is one: several networks in several threads share the processor, and equal
/// inputs give equal bits.
class OneThread {
 public:
  OneThread() : before_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

}  // namespace bodyloom
