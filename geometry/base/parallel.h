// SPDX-License-Identifier: Apache-2.0
/// ParallelFor(count, num_threads, body): calls body(i) once for every i in 0..count−1, on up to num_threads threads,
/// the caller's among them. Which thread runs which i is left open, so a result is the same for any number of threads
/// exactly when body(i) writes only what belongs to i. The first exception of a body is rethrown after all threads have
/// stopped; indices not yet started are then skipped. With one thread, or one index, no other thread takes part.
///
/// Threads are kept from one call to the next: starting one costs as much as many a loop (docs/concepts.md, "Threads").
/// Calls may be nested, and come from several threads at once; a call that finds no free thread does its work alone.
#pragma once

#include <functional>
#include <vector>

namespace bodyloom {

/// The number of threads that an option asks for: `requested` when it is positive, else one a core.
int ThreadsFor(int requested);

void ParallelFor(int count, int num_threads, const std::function<void(int)>& body);

// Work in phases, each of which needs all of the one before it, on threads that are started once: starting a thread
// costs as much as a phase of a single picture.

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
