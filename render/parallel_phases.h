// SPDX-License-Identifier: Apache-2.0
/// Work in phases, each of which needs all of the one before it, on threads that are started once: starting a thread
/// costs as much as a phase of a single picture.
#pragma once

#include <functional>
#include <vector>

namespace bodyloom {

struct Phase {
  std::function<int()> count;     ///< how many tasks; called once, by one thread, when the phase before is done
  std::function<void(int)> task;  ///< called once for every i in 0..count()−1
};

/// Runs the phases in order on up to num_threads threads, the caller's among them (geometry/base/parallel.h). Which
/// thread runs which task is left open, so a result is the same for any number of threads exactly when a task writes
/// only what belongs to it. The first exception is rethrown after all threads have stopped; what has not started is
/// skipped then.
void RunPhases(int num_threads, const std::vector<Phase>& phases);

}  // namespace bodyloom
