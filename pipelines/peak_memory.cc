// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/peak_memory.h"

#include <sys/resource.h>

namespace bodyloom {

size_t PeakMemoryBytes() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<size_t>(usage.ru_maxrss) * 1024;  // Linux counts KiB
}

}  // namespace bodyloom
