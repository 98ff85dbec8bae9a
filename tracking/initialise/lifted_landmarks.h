// SPDX-License-Identifier: Apache-2.0
/// The body's points that the lifter speaks of.
#pragma once

#include <array>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/lifter_weights.h"
#include "bodyloom/tracking/body_points.h"
#include "bodyloom/tracking/initialise/lift_keypoints.h"

namespace bodyloom {

/// The lifter's landmarks, compiled for a body.
struct LiftedLandmarks {
  std::array<CompiledPoint, LifterOutput::kPoints> points;
  std::array<bool, LifterOutput::kPoints> known{};  ///< the body has it
  /// Both hips, both shoulders and a way to measure the body's length: without them nothing can be lifted.
  [[nodiscard]] bool IsUsable() const;
};
LiftedLandmarks CompileLiftedLandmarks(const BodyModel& model, int num_betas);

}  // namespace bodyloom
