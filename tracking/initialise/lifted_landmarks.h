// SPDX-License-Identifier: Apache-2.0
/// The lifter's landmarks as points of the body.
#pragma once

#include <array>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/lifter_weights.h"
#include "tracking/lifter/lift_keypoints.h"
#include "tracking/problem/body_points.h"

namespace bodyloom {

/// The lifter's landmarks, compiled for a body.
struct LiftedLandmarks {
  /// The landmark whose uncertainty is a joint's: the one that is nearest in the rest pose. `share`: the joint's
  /// distance from the middle of the hips over the landmark's, at most 1.
  struct Nearest {
    int landmark = -1;  ///< −1: the body has none
    double share = 0;
  };
  std::array<CompiledPoint, LifterOutput::kPoints> points;
  std::array<bool, LifterOutput::kPoints> known{};  ///< the body has it
  std::vector<Nearest> of_joint;                    ///< J
  /// True if the body has both hips, both shoulders and the landmarks of its reference length, which the lifter needs.
  [[nodiscard]] bool IsUsable() const;
};
LiftedLandmarks CompileLiftedLandmarks(const BodyModel& model, int num_betas);

}  // namespace bodyloom
