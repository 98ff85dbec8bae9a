// SPDX-License-Identifier: Apache-2.0
/// What a distant light sees of a mesh, by which it is known where its light falls.
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
  /// Sees the mesh along parallel rays, `size_px` pixels across the sphere around it; both sides of faces cast shadows.
  /// `towards`: unit vector to the light, in the frame of the vertices (V×3, metres). Throws std::invalid_argument when
  /// it is not a unit vector or there is no vertex; as VisibilityBuffer::Render.
  void Render(const MatrixX3d& vertices, const MatrixX3i& faces, const Eigen::Vector3d& towards, int size_px);

  /// Whether the light reaches a point: nothing is nearer to the light by more than two of the map's pixels. Outside
  /// the map: true. Points of the mesh itself are to be lifted off it, along the normal, by about as much.
  [[nodiscard]] bool Reaches(const Eigen::Vector3d& point) const;

  /// The share of 4×4 points, spread evenly over a square of 2 `softness_m` across the light's direction, that it
  /// reaches: a shadow's edge is as wide as that.
  [[nodiscard]] double ShareReaching(const Eigen::Vector3d& point, double softness_m) const;

  [[nodiscard]] double metres_a_pixel() const { return 1 / camera_.scale; }

 private:
  [[nodiscard]] bool ReachesInLight(const Eigen::Vector3d& point_in_light) const;

  Eigen::Matrix3d light_from_mesh_ = Eigen::Matrix3d::Identity();  ///< z away from the light
  Camera camera_;
  VisibilityBuffer seen_;
};

// How open to the light of all around each place of a mesh is (ambient occlusion).

/// Works out openness; keeps its memory between meshes. Not for use by two threads at once.
class OpennessOfMesh {
 public:
  /// Of each vertex, the share of the light that reaches it when the same comes from everywhere:
  ///   Σ_k max(0, n·d_k) v_k / Σ_k max(0, n·d_k)
  /// with unit normals n (V×3; zero: open), 48 directions d_k (geometry/math/direction_bins.h), and v_k whether
  /// anything of the mesh is in the way from a point 2 cm above the vertex. 1 everywhere on a convex mesh.
  const std::vector<float>& Compute(const MatrixX3d& vertices, const MatrixX3f& normals, const MatrixX3i& faces);

 private:
  ShadowMap map_;
  std::vector<float> openness_, whole_;
};

}  // namespace bodyloom
