// SPDX-License-Identifier: Apache-2.0
/// How a pipeline talks to whoever runs the command: a progress bar on stderr, lines on stdout, Ctrl-C.
#pragma once

#include <string>

#include "apps/progress.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

/// Progress moves the bar, which must outlive the callbacks; messages are lines on stdout; once the user pressed Ctrl-C
/// (apps/interrupt.h) the job is cancelled.
PipelineCallbacks CallbacksFor(Progress* progress);

/// The answer of `job(request, callbacks)`, run under a bar of this title, which is gone when it returns.
template <class Job, class Request>
auto RunWithBar(const std::string& title, const Job& job, const Request& request) {
  Progress bar(title);
  return job(request, CallbacksFor(&bar));
}

}  // namespace bodyloom
