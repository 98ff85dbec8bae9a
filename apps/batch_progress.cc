// SPDX-License-Identifier: Apache-2.0
#include "apps/batch_progress.h"

#include <ostream>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/fixed_text.h"

namespace bodyloom {
namespace {

constexpr std::chrono::seconds kJsonInterval{1};

}  // namespace

BatchProgressPrinter::BatchProgressPrinter(const std::string& style, std::ostream& out)
    : out_(out), json_(style == "json") {
  if (style == "text") progress_ = std::make_unique<Progress>("clips", Progress::DefaultStyle(), out);
}

void BatchProgressPrinter::Update(const BatchProgress& at) {
  if (progress_) progress_->Update(Concatenate(at.ended, " of ", at.all), at.whole);
  const Clock::time_point now = Clock::now();
  const bool is_new = at.stage == kBatchStageBegin;
  if (!json_ || (!is_new && now - last_ < kJsonInterval)) return;
  last_ = now;
  // Ids need no escapes, and stages are words of this program's.
  out_ << "{\"clip\":\"" << at.clip << "\",\"stage\":\"" << at.stage << "\",\"fraction\":" << Fixed(at.fraction, 4)
       << ",\"ended\":" << at.ended << ",\"all\":" << at.all << ",\"whole\":" << Fixed(at.whole, 4) << "}" << std::endl;
}

void BatchProgressPrinter::Wipe() {
  if (progress_) progress_->Wipe();
}

}  // namespace bodyloom
