// SPDX-License-Identifier: Apache-2.0
#include "apps/progress_callbacks.h"

#include <iostream>

#include "apps/interrupt.h"

namespace bodyloom {

PipelineCallbacks CallbacksFor(Progress* progress) {
  PipelineCallbacks callbacks;
  callbacks.progress = [progress](const std::string& stage, double fraction) {
    progress->Update(stage, fraction);
    return !IsInterrupted();
  };
  callbacks.message = [](const std::string& line) { std::cout << line << "\n" << std::flush; };
  return callbacks;
}

}  // namespace bodyloom
