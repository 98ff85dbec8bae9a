// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/early_stopping.h"

#include <algorithm>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

int64_t ShareOrMinimum(double share, int64_t steps, int64_t minimum) {
  return std::max(minimum, static_cast<int64_t>(share * static_cast<double>(steps)));
}

}  // namespace

bool EarlyStoppingOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("held-out every", every, 0, 1e8) && in_range("held-out smoothed", smoothed, 1, 1000) &&
         in_range("min_patience", double(min_patience), 1, 1e8) &&
         in_range("min_cooldown", double(min_cooldown), 1, 1e8) && in_range("patience_share", patience_share, 0, 1e3) &&
         in_range("cooldown_share", cooldown_share, 0, 1e3);
}

int64_t EarlyStopping::BestStep(const EarlyStoppingOptions& options) const {
  double best = std::numeric_limits<double>::infinity();
  int64_t step = 0;
  for (size_t k = 0; k < losses.size(); ++k) {
    const size_t first = k + 1 - std::min<size_t>(k + 1, options.smoothed);
    double sum = 0;
    for (size_t i = first; i <= k; ++i) sum += losses[i];
    if (const double mean = sum / static_cast<double>(k + 1 - first); mean < best) {
      best = mean;
      step = static_cast<int64_t>(k + 1) * options.every;
    }
  }
  return step;
}

void EarlyStopping::Add(double loss, int64_t step, double progress, const EarlyStoppingOptions& options) {
  losses.push_back(loss);
  if (cooldown_step > 0) return;
  const int64_t best = BestStep(options);
  if (step - best < ShareOrMinimum(options.patience_share, best, options.min_patience)) return;
  cooldown_step = step;
  cooldown_progress = progress;
}

double EarlyStopping::Progress(int64_t step, const EarlyStoppingOptions& options) const {
  if (cooldown_step == 0) return 0;
  const int64_t length = ShareOrMinimum(options.cooldown_share, cooldown_step, options.min_cooldown);
  const double landed = static_cast<double>(step - cooldown_step) / static_cast<double>(length);
  return std::min(1.0, cooldown_progress + (1 - cooldown_progress) * landed);
}

}  // namespace bodyloom
