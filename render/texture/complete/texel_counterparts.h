// SPDX-License-Identifier: Apache-2.0
/// The points of a body that correspond to a texel's by symmetry, for guesses at what a picture does not show. Of a
/// point that one side of the body at rest (rest_views.h) shows at (x, y):
///   mirror       what the same side shows at (−x, y)          the other arm
///   behind       what the other side shows at (x, y)          the back of the same arm
///   across       what the other side shows at (−x, y)
/// A point that neither side shows (in a fold) corresponds to nothing.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/texture/complete/rest_views.h"

namespace bodyloom {

enum TexelCounterpart { kMirror, kBehind, kAcross, kNumCounterparts };

/// One a texel of the table; face −1: none.
using TexelCounterparts = std::array<std::vector<SurfacePoint>, kNumCounterparts>;

/// The texels' points, n×3, from a body at rest (V×3, metres).
MatrixX3d TexelPoints(const MatrixX3d& rest_vertices, const MatrixX3i& faces, const UvTexelTable& table);

/// `points`: TexelPoints() of the body that `views` see.
TexelCounterparts FindTexelCounterparts(const RestViews& views, const MatrixX3d& points);

// The nearest known point around a limb or the trunk: clothes change along a limb far more often than around it.
//
// In the two pictures of the body at rest (rest_views.h) the arms lie along x, all else along y. A pixel looks along
// the other axis, in both pictures, for the nearest that shows something known: a shirt's side finds the shirt at its
// own height and never the trousers.

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
