// SPDX-License-Identifier: Apache-2.0
#include "tracking/builtin_models.h"

#include "data_tools/body/builtin_body.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"

namespace bodyloom {
namespace {

template <typename Input>
void AddBuiltins(bool needs_prior, bool needs_lifter, Input* input) {
  if (input->body == nullptr) input->body = &BuiltinBody();
  if (input->prior == nullptr && needs_prior) input->prior = &BuiltinPosePrior();
  if (input->lifter == nullptr && needs_lifter) input->lifter = &BuiltinLifter();
}

}  // namespace

TrackSequenceInput WithBuiltins(TrackSequenceInput input, const TrackSequenceOptions& options) {
  AddBuiltins(options.prior_weight != 0, options.lifter_weight != 0 && input.lifted == nullptr, &input);
  return input;
}

LiveTrackerInput WithBuiltins(LiveTrackerInput input) {
  AddBuiltins(true, true, &input);
  return input;
}

}  // namespace bodyloom
