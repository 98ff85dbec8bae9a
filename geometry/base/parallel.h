// SPDX-License-Identifier: Apache-2.0
/// ParallelFor(count, num_threads, body): calls body(i) once for every i in 0..count−1, on up to num_threads threads,
/// the caller's among them. The assignment of indices to threads is not specified, so a result is the same for any
/// number of threads exactly when body(i) writes only what belongs to i. The first exception of a body is rethrown
/// after all threads have stopped; indices not yet started are then skipped. With one thread, or one index, no other
/// thread takes part.
///
/// Threads are kept from one call to the next: starting one costs as much as many loops (docs/concepts.md, "Threads").
/// Calls may be nested, and come from several threads at once; a call that finds no free thread does its work alone.
#pragma once

#include <functional>
#include <vector>

namespace bodyloom {

/// Returns `requested` when it is positive, else one thread per core.
int ThreadsFor(int requested);

void ParallelFor(int count, int num_threads, const std::function<void(int)>& body);

// Work in phases, each of which needs the whole phase before it, on threads that are started once: starting a thread
// costs as much as one phase for a single image.

struct Phase {
  std::function<int()> count;     ///< how many tasks; called once, by one thread, when the phase before is done
  std::function<void(int)> task;  ///< called once for every i in 0..count()−1
};

/// Runs the phases in order on up to num_threads threads, the caller's among them. The assignment of tasks to threads
/// is not specified, so a result is the same for any number of threads exactly when a task writes only what belongs to
/// it. The first exception is rethrown after all threads have stopped; tasks not yet started are then skipped.
void RunPhases(int num_threads, const std::vector<Phase>& phases);

}  // namespace bodyloom
