// SPDX-License-Identifier: Apache-2.0
/// The nearest known point around a limb or the trunk: clothes change along a limb far more often than around it.
///
/// In the two pictures of the body at rest (rest_views.h) the arms lie along x, all else along y. A pixel looks along the
/// other axis, in both pictures, for the nearest that shows something known: a shirt's side finds the shirt at its own
/// height and never the trousers.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/surface_point.h"
#include "bodyloom/render/person/rest_views.h"

namespace bodyloom {

class NearestAroundLimb {
 public:
  /// `is_known`: whether something is known of a point of the surface. Borrows `views`.
  NearestAroundLimb(const BodyModel& body, const RestViews& views,
                    const std::function<bool(const SurfacePoint&)>& is_known);

  /// The nearest known point for a point of the body at rest; face −1: none at its height.
  [[nodiscard]] SurfacePoint At(const Eigen::Vector3d& point) const;

 private:
  struct Found {
    int16_t x = -1, y = -1;
    bool behind = false;
  };
  const RestViews& views_;
  std::vector<Found> found_;
};

}  // namespace bodyloom
