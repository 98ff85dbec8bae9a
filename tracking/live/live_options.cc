// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_options.h"

#include "geometry/base/check.h"

namespace bodyloom {

bool LiveTrackerOptions::IsValid(std::string* why) const {
  const auto in_range = [&](const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return true;
    *why = Concatenate(name, " is ", value, ", expected ", low, " to ", high);
    return false;
  };
  if (solve.solver == SequenceSolver::kCeres) {
    *why = "a window of frames is solved by the chain engine, not by " + ToString(solve.solver);
    return false;
  }
  if (solve.velocity_weight > 0) {
    *why = "velocities cost something in whole clips alone: expected velocity_weight 0";
    return false;
  }
  for (const UserTerm& term : solve.user_terms) {
    if (term.is_of_one_frame()) continue;
    *why = "the term '" + term.name + "' couples frames, which leave a live tracker's window one by one";
    return false;
  }
  return solve.IsValid(why) && in_range("lag", lag, 0, 60) && in_range("context", context, 3, 60) &&
         in_range("iterations", iterations, 1, 50) && in_range("start_iterations", start_iterations, 1, 50) &&
         in_range("max_dense", max_dense, 1, 1e7) && in_range("lost_after_s", lost_after_s, 0, 10) &&
         in_range("max_jump_s", max_jump_s, 0, 1) && in_range("reuse_linearisation", reuse_linearisation, 0, 0.1);
}

}  // namespace bodyloom
