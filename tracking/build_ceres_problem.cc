// SPDX-License-Identifier: Apache-2.0
#include "tracking/build_ceres_problem.h"

#include <utility>

#include "geometry/base/parallel.h"
#include "tracking/builtin_models.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/problem/input_checks.h"

namespace bodyloom {

ClipCeresProblem::ClipCeresProblem(const TrackSequenceInput& input, const TrackSequenceOptions& options)
    : options_(options), fit_(std::make_unique<ClipFit>(input, options_, &result_.summary)) {
  if (!fit_->FindStart()) return;
  fit_->Observe();
  fit_->FitCoarseFrames();
  fit_->FitAllFrames();
  blocks_ = std::make_unique<CeresProblem>(
      *fit_->problem(),
      CeresProblemOptions{.num_threads = ThreadsFor(options_.num_threads), .enable_fast_removal = true});
}

ClipCeresProblem::~ClipCeresProblem() = default;

TrackSequenceResult ClipCeresProblem::Finish() {
  if (blocks_ != nullptr) {
    blocks_->CopyTo(fit_->problem());
    fit_->Finish(&result_);
    result_.summary.final_cost = 0;  // of the values now, with the weights that terms have of themselves
    for (const TermCost& cost : result_.summary.costs) result_.summary.final_cost += cost.cost;
  }
  return std::move(result_);
}

std::unique_ptr<ClipCeresProblem> BuildCeresProblem(const TrackSequenceInput& input,
                                                    const TrackSequenceOptions& options) {
  const TrackSequenceInput whole = WithBuiltins(input, options);
  CheckInput(whole, options);
  return std::make_unique<ClipCeresProblem>(whole, options);
}

}  // namespace bodyloom
