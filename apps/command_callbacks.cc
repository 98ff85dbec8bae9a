// SPDX-License-Identifier: Apache-2.0
#include "apps/command_callbacks.h"

#include <memory>
#include <optional>

#include "apps/interrupt.h"
#include "apps/progress.h"

namespace bodyloom {

PipelineCallbacks CommandCallbacks(bool quiet, std::ostream& messages) {
  const Progress::Style style = quiet ? Progress::Style::kSilent : Progress::DefaultStyle();
  const auto shown = std::make_shared<std::optional<Progress>>();
  PipelineCallbacks callbacks;
  callbacks.begin = [shown, style](const std::string& work) { shown->emplace(work, style); };
  callbacks.progress = [shown](const std::string& stage, double fraction) {
    if (*shown) (*shown)->Update(stage, fraction);
    return !IsInterrupted();
  };
  callbacks.message = [shown, &messages](const std::string& line) {
    if (*shown) (*shown)->Wipe();
    messages << line << std::endl;
  };
  return callbacks;
}

}  // namespace bodyloom
