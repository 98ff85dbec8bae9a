// SPDX-License-Identifier: Apache-2.0
/// A body at rest (x to its left, y up, z to the front) seen from the front and from behind, orthographically, to find
/// points at the same position from both sides or at the same height.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

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

}  // namespace bodyloom
