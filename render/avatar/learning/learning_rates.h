// SPDX-License-Identifier: Apache-2.0
/// How far each number of a person of Gaussians moves in a step of training.
#pragma once

#include <array>
#include <string>

#include "bodyloom/render/avatar/gaussian_body.h"

namespace bodyloom {

/// Adam's rates; those of a parameter that is to stay are 0. Places become finer in the course of training: theirs goes
/// exponentially from `position` to position · position_at_end, and that of the motion's network likewise.
struct AvatarRates {
  float position = 3e-4F, position_at_end = 0.03F;  ///< metres
  float quaternion = 4e-3F, log_scale = 6e-3F, opacity_logit = 3e-2F, albedo = 8e-3F, normal = 1e-2F;
  float weight_logit = 1e-2F;
  float light = 2e-3F;
  float motion = 1.5e-3F, motion_at_end = 0.05F;  ///< of the network's parameters
  [[nodiscard]] bool IsValid(std::string* why) const;
  /// By column of GaussianBody::parameters, `progress` in [0, 1] of the training.
  [[nodiscard]] std::array<float, GaussianBody::kNumParameters> At(double progress) const;
  [[nodiscard]] float MotionAt(double progress) const;
};

}  // namespace bodyloom
