// SPDX-License-Identifier: Apache-2.0
/// Setup of a live tracker, fixed before the first frame: body, camera, priors, and the joints that are unknowns.
#pragma once

#include <array>
#include <memory>

#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/live/live_options.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/terms/joint_limits.h"
#include "tracking/terms/observability.h"
#include "tracking/terms/pose_prior/pose_prior.h"

namespace bodyloom {

/// Points into itself: not to be copied.
struct LiveSetup {
  /// Throws std::invalid_argument for invalid input or options.
  LiveSetup(const LiveTrackerInput& given, const LiveTrackerOptions& chosen);
  LiveSetup(const LiveSetup&) = delete;
  LiveSetup& operator=(const LiveSetup&) = delete;

  /// A problem without frames, with the clip's layout and with shape and focal length at the means of their priors.
  [[nodiscard]] SequenceProblem EmptyProblem() const;
  /// Throws std::invalid_argument when a frame cannot follow one at `last_s` seconds (null: it is the first).
  void CheckObservations(const LiveObservations& observations, const double* last_s) const;

  const LiveTrackerInput input;
  const LiveTrackerOptions options;
  int threads = 1;
  FrameLayout layout;
  std::vector<std::shared_ptr<const CompiledInputs>> user_inputs;  ///< of options.solve.user_terms
  ObservedLandmarks landmarks;
  LiftedLandmarks lifted_landmarks;
  std::shared_ptr<const MixturePrior> prior;  ///< null: none
  std::shared_ptr<const JointLimits> limits;
  std::array<int, 2> knees = {-1, -1};
  double stature_m = 0;  ///< of the mean shape
};

}  // namespace bodyloom
