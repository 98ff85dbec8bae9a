// SPDX-License-Identifier: Apache-2.0
/// Shadow map of a distant light: the depth of a mesh as seen from the light.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

/// Keeps its memory between meshes. Not for use by two threads at once.
class ShadowMap {
 public:
  /// Renders the mesh along parallel rays, `size_px` pixels across its bounding sphere; both sides of faces cast
  /// shadows. `towards`: unit vector to the light, in the frame of the vertices (V×3, metres). Throws
  /// std::invalid_argument when it is not a unit vector or there is no vertex; as VisibilityBuffer::Render.
  void Render(const MatrixX3d& vertices, const MatrixX3i& faces, const Eigen::Vector3d& towards, int size_px);

  /// Returns true if a point is lit: nothing is nearer to the light by more than two of the map's pixels. True outside
  /// the map. Offset points of the mesh itself along the normal by about as much.
  [[nodiscard]] bool Reaches(const Eigen::Vector3d& point) const;

  /// The lit share of 4×4 points on a square of side 2 `softness_m` perpendicular to the light: the width of a shadow's
  /// soft edge.
  [[nodiscard]] double ShareReaching(const Eigen::Vector3d& point, double softness_m) const;

  [[nodiscard]] double metres_a_pixel() const { return 1 / camera_.scale; }

 private:
  [[nodiscard]] bool ReachesInLight(const Eigen::Vector3d& point_in_light) const;

  Eigen::Matrix3d light_from_mesh_ = Eigen::Matrix3d::Identity();  ///< z away from the light
  Camera camera_;
  VisibilityBuffer seen_;
};

// Ambient occlusion of a mesh by shadow maps from many directions.

/// Keeps its memory between meshes. Not for use by two threads at once.
class AmbientOcclusion {
 public:
  /// Computes for each vertex the share of uniform ambient light that reaches it:
  ///   Σ_k max(0, n·d_k) v_k / Σ_k max(0, n·d_k)
  /// with unit normals n (V×3; zero: open), 48 directions d_k (geometry/math/direction_bins.h), and v_k = 0 if the mesh
  /// occludes direction d_k from a point 2 cm above the vertex, else 1. The result is 1 everywhere on a convex mesh.
  const std::vector<float>& Compute(const MatrixX3d& vertices, const MatrixX3f& normals, const MatrixX3i& faces);

 private:
  ShadowMap map_;
  std::vector<float> ambient_occlusion_, whole_;
};

}  // namespace bodyloom
