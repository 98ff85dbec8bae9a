// SPDX-License-Identifier: Apache-2.0
/// ParallelFor(count, num_threads, body): calls body(i) once for every i in 0..count−1, on up to num_threads threads,
/// the caller's among them. Which thread runs which i is left open, so a result is the same for any number of threads
/// exactly when body(i) writes only what belongs to i. The first exception of a body is rethrown after all threads have
/// stopped; indices not yet started are then skipped. With one thread, or one index, no thread is started.
#pragma once

#include <functional>

namespace bodyloom {

void ParallelFor(int count, int num_threads, const std::function<void(int)>& body);

}  // namespace bodyloom
