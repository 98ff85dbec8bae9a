// SPDX-License-Identifier: Apache-2.0
/// How far each number of a person of Gaussians moves in a step of training.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "bodyloom/render/avatar/gaussian_body.h"

namespace bodyloom {

/// Adam's rates; those of a parameter that is to stay are 0. Places become finer in the course of training: theirs goes
/// exponentially from `position` to position · position_at_end. All other numbers of a Gaussian settle: after n steps,
/// at `progress` p, theirs are
///   rate · others_at_end^max(0, 2p − 1) / sqrt(1 + n/settle_steps)
/// Adam's steps are as long where a picture hardly says anything as where it says all, so what no picture asks for (a normal
/// in shade, the weights of skin that is seen in one pose) wanders: by rate · sqrt(n) at a rate that stays, which other
/// poses then show, by the root of the logarithm of n at this one.
struct AvatarRates {
  float position = 3e-4F, position_at_end = 0.03F;  ///< metres
  float quaternion = 4e-3F, log_scale = 6e-3F, opacity_logit = 3e-2F, albedo = 8e-3F, normal = 1e-2F;
  float weight_logit = 1e-2F;
  float others_at_end = 0.03F;  ///< above 0, at most 1
  float settle_steps = 3000;    ///< 1 to 1e9
  float light = 2e-3F;
  [[nodiscard]] bool IsValid(std::string* why) const;
  /// By column of GaussianBody::parameters, `progress` in [0, 1] of the training, `step` from 0 on.
  [[nodiscard]] std::array<float, GaussianBody::kNumParameters> At(double progress, int64_t step) const;
};

}  // namespace bodyloom
