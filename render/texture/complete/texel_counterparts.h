// SPDX-License-Identifier: Apache-2.0
/// Finds the points of a body that correspond to a texel's by symmetry, to guess colours of unseen texels. For a point
/// that one side of the body at rest (RestViews) shows at (x, y):
///   mirror       the point that the same side shows at (−x, y)      the other arm
///   behind       the point that the other side shows at (x, y)      the back of the same arm
///   across       the point that the other side shows at (−x, y)
/// A point that neither side shows (in a fold) has no counterpart.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

// A body at rest (x to its left, y up, z to the front) seen from the front and from behind, orthographically, to find
// points at the same position from both sides or at the same height.

enum class RestSide { kFront, kBack };

class RestViews {
 public:
  static constexpr int kPixels = 1024;  ///< side of both images

  /// Borrows the faces. `rest_vertices`: V×3, metres.
  RestViews(const MatrixX3d& rest_vertices, const MatrixX3i& faces);

  /// The side that sees the surface point; none for a point in a fold.
  [[nodiscard]] std::optional<RestSide> SideOf(const Eigen::Vector3d& point) const;
  /// The surface point that a side sees at the position of `point`, for any depth; face −1: none.
  [[nodiscard]] SurfacePoint At(RestSide side, const Eigen::Vector3d& point) const;

  /// Pixel of a point: both images have x to the body's left and y down, so it is the same in both.
  [[nodiscard]] Eigen::Vector2i PixelOf(const Eigen::Vector3d& point) const;
  [[nodiscard]] Eigen::Vector3d PointAt(int x, int y) const;  ///< on the plane z = 0

 private:
  struct View {
    Eigen::Vector3d sign;
    MatrixX3d vertices;
    VisibilityBuffer buffer;
  };
  [[nodiscard]] const View& Of(RestSide side) const { return views_[side == RestSide::kFront ? 0 : 1]; }
  [[nodiscard]] bool Sees(RestSide side, const Eigen::Vector3d& point) const;

  const MatrixX3i& faces_;
  Camera camera_;
  std::array<View, 2> views_;
};

enum TexelCounterpart { kMirror, kBehind, kMirroredBack, kNumCounterparts };

/// One entry per texel of the table; face −1: none.
using TexelCounterparts = std::array<std::vector<SurfacePoint>, kNumCounterparts>;

/// Positions of the texels, n×3, on a body at rest (V×3, metres).
MatrixX3d TexelPoints(const MatrixX3d& rest_vertices, const MatrixX3i& faces, const UvTexelTable& table);

/// `points`: TexelPoints() of the body of `views`.
TexelCounterparts FindTexelCounterparts(const RestViews& views, const MatrixX3d& points);

// Finds the nearest known point around a limb or the trunk: clothes vary along a limb far more than around it.
//
// In the two images of the body at rest (RestViews) the arms lie along x, all else along y. The nearest known pixel
// is searched along the other axis in both images, so that the side of a shirt finds the shirt at its own height, never
// the trousers.

class NearestAroundLimb {
 public:
  /// `is_known`: returns true for known points of the surface. Borrows `views`.
  NearestAroundLimb(const BodyModel& body, const RestViews& views,
                    const std::function<bool(const SurfacePoint&)>& is_known);

  /// The known point nearest to a point of the body at rest; face −1: none at its height.
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
