// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/motion/avatar_motion.h"

#include <algorithm>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/render/avatar/gaussian_body.h"

namespace bodyloom {

AvatarMotion::AvatarMotion(const BodyModel& body, const MotionNetworkOptions& options, const MotionLimits& limits)
    : offsets_(body, options.side, limits), network_(options, offsets_.ShowsBody()) {
  BODYLOOM_CHECK(options.outputs == kMotionChannels, "avatar motion: ", options.outputs, " outputs, expected ",
                 kMotionChannels);
}

size_t AvatarMotion::num_values() const {
  return static_cast<size_t>(options().maps) * options().side * options().side;
}

void AvatarMotion::Compute(const FloatColumns& parameters, std::span<const float> maps, int num_threads,
                           GaussianOffsets* offsets) {
  map_ = &network_.Forward(parameters, maps, num_threads);
  offsets_.Compute(*map_, num_threads, offsets);
}

void AvatarMotion::Back(const FloatColumns& parameters, const FloatColumns& by_gaussians, int num_threads,
                        FloatColumns* by_parameters) {
  BODYLOOM_CHECK(map_ != nullptr, "avatar motion: nothing was computed to go back from");
  by_offsets_.Resize(GaussianOffsets::kNumColumns, by_gaussians.rows());
  for (int c = 0; c < GaussianOffsets::kNumColumns; ++c) {
    const int from = c < GaussianOffsets::kLogScale ? GaussianBody::kPosition + c
                                                    : GaussianBody::kLogScale + c - GaussianOffsets::kLogScale;
    std::copy_n(by_gaussians.column(from), by_gaussians.rows(), by_offsets_.column(c));
  }
  offsets_.Back(*map_, by_offsets_, num_threads, &by_map_);
  network_.Backward(parameters, by_map_, num_threads, by_parameters);
}

}  // namespace bodyloom
