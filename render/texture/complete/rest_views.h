// SPDX-License-Identifier: Apache-2.0
/// A body at rest (x to its left, y up, z to the front) seen from the front and from behind, orthographically: what
/// lies at the same place from both sides, and what lies at one height.
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
  static constexpr int kPixels = 1024;  ///< of both pictures, a side

  /// Borrows the faces. `rest_vertices`: V×3, metres.
  RestViews(const MatrixX3d& rest_vertices, const MatrixX3i& faces);

  /// The side that sees the point of the surface; none for one in a fold.
  [[nodiscard]] std::optional<RestSide> SideOf(const Eigen::Vector3d& point) const;
  /// What a side sees where `point` is, whatever its depth; face −1: nothing.
  [[nodiscard]] SurfacePoint At(RestSide side, const Eigen::Vector3d& point) const;

  /// Both pictures have x to the body's left and y down, so that what lies at one place of the body has one pixel.
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
