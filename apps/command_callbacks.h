// SPDX-License-Identifier: Apache-2.0
/// Callbacks of the command: a pipeline's reports on a terminal, progress on stderr, messages as lines; Ctrl-C cancels
/// it.
#pragma once

#include <iostream>
#include <string>

#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

/// Work that has a name (PipelineCallbacks::begin) gets a bar or lines on stderr (apps/progress.h), nothing when
/// `quiet`; work without one shows nothing. A raised interrupt flag (apps/interrupt.h) cancels the job. Messages go to
/// `messages`, which must outlive the callbacks. The bar is wiped when the last copy of the callbacks goes.
PipelineCallbacks CommandCallbacks(bool quiet = false, std::ostream& messages = std::cout);

/// The answer of `job(request, callbacks)`, run under a bar of this title, which is gone when it returns.
template <class Job, class Request>
auto RunWithBar(const std::string& title, const Job& job, const Request& request) {
  const PipelineCallbacks callbacks = CommandCallbacks();
  callbacks.Begin(title);
  return job(request, callbacks);
}

}  // namespace bodyloom
