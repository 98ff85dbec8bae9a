// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/learning/learning_rates.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/in_range.h"

namespace bodyloom {
namespace {

/// From `rate` to rate · at_end, exponentially.
float Shrunk(double rate, double at_end, double progress) {
  return static_cast<float>(rate * std::pow(at_end, std::clamp(progress, 0.0, 1.0)));
}

}  // namespace

bool AvatarRates::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("rate of position", position, 0, 1) && in_range("position_at_end", position_at_end, 1e-6, 1) &&
         in_range("rate of quaternion", quaternion, 0, 1) && in_range("rate of log_scale", log_scale, 0, 1) &&
         in_range("rate of opacity_logit", opacity_logit, 0, 1) && in_range("rate of albedo", albedo, 0, 1) &&
         in_range("rate of normal", normal, 0, 1) && in_range("rate of weight_logit", weight_logit, 0, 1) &&
         in_range("rate of light", light, 0, 1) && in_range("others_at_end", others_at_end, 1e-6, 1) &&
         in_range("settle_steps", settle_steps, 1, 1e9);
}

std::array<float, GaussianBody::kNumParameters> AvatarRates::At(double progress, int64_t step) const {
  std::array<float, GaussianBody::kNumParameters> rates{};
  const auto set = [&](int first, int count, double rate) {
    std::fill_n(rates.begin() + first, count, static_cast<float>(rate));
  };
  const double settled = Shrunk(1, others_at_end, 2 * progress - 1) / std::sqrt(1 + double(step) / settle_steps);
  set(GaussianBody::kPosition, 3, Shrunk(position, position_at_end, progress));
  set(GaussianBody::kQuaternion, 4, settled * quaternion);
  set(GaussianBody::kLogScale, 3, settled * log_scale);
  set(GaussianBody::kOpacityLogit, 1, settled * opacity_logit);
  set(GaussianBody::kAlbedo, 3, settled * albedo);
  set(GaussianBody::kNormal, 3, settled * normal);
  set(GaussianBody::kWeightLogit, GaussianBody::kInfluences, settled * weight_logit);
  return rates;
}

}  // namespace bodyloom
