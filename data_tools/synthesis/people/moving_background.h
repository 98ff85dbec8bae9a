// SPDX-License-Identifier: Apache-2.0
/// The background of a synthetic person: a picture made of gradients, noise and a few shapes, slowly panning.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "bodyloom/render/image.h"

namespace bodyloom {

/// Immutable, may be shared by threads.
class MovingBackground {
 public:
  /// Throws std::invalid_argument for a size that is not positive.
  MovingBackground(int width, int height, uint64_t seed);

  /// The view at a time (seconds), of the size given: the large picture, which goes on beyond its borders as in a
  /// mirror, sampled bilinearly at whole pixels + velocity · time.
  [[nodiscard]] Image At(double time_s) const;
  [[nodiscard]] const Eigen::Vector2d& velocity_px_s() const { return velocity_px_s_; }

 private:
  int width_, height_;
  Image picture_;
  Eigen::Vector2d velocity_px_s_;
};

}  // namespace bodyloom
