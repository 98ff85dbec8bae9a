// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/held_out_curve.h"

#include <algorithm>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

int64_t ShareOrLeast(double share, int64_t steps, int64_t least) {
  return std::max(least, static_cast<int64_t>(share * static_cast<double>(steps)));
}

}  // namespace

bool HeldOutOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("held-out every", every, 0, 1e8) && in_range("held-out smoothed", smoothed, 1, 1000) &&
         in_range("least_wait", double(least_wait), 1, 1e8) &&
         in_range("least_landing", double(least_landing), 1, 1e8) && in_range("wait_share", wait_share, 0, 1e3) &&
         in_range("landing_share", landing_share, 0, 1e3);
}

int64_t HeldOutCurve::BestStep(const HeldOutOptions& options) const {
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

void HeldOutCurve::Add(double loss, int64_t step, double progress, const HeldOutOptions& options) {
  losses.push_back(loss);
  if (landing_step > 0) return;
  const int64_t best = BestStep(options);
  if (step - best < ShareOrLeast(options.wait_share, best, options.least_wait)) return;
  landing_step = step;
  landing_progress = progress;
}

double HeldOutCurve::Progress(int64_t step, const HeldOutOptions& options) const {
  if (landing_step == 0) return 0;
  const int64_t length = ShareOrLeast(options.landing_share, landing_step, options.least_landing);
  const double landed = static_cast<double>(step - landing_step) / static_cast<double>(length);
  return std::min(1.0, landing_progress + (1 - landing_progress) * landed);
}

}  // namespace bodyloom
