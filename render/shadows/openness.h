// SPDX-License-Identifier: Apache-2.0
/// How open to the light of all around each place of a mesh is (ambient occlusion).
#pragma once

#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/render/shadows/shadow_map.h"

namespace bodyloom {

/// Works out openness; keeps its memory between meshes. Not for use by two threads at once.
class OpennessOfMesh {
 public:
  /// Of each vertex, the share of the light that reaches it when the same comes from everywhere:
  ///   Σ_k max(0, n·d_k) v_k / Σ_k max(0, n·d_k)
  /// with unit normals n (V×3; zero: open), 48 directions d_k (geometry/direction_bins.h), and v_k whether anything
  /// of the mesh is in the way from a point 2 cm above the vertex. 1 everywhere on a convex mesh.
  const std::vector<float>& Compute(const MatrixX3d& vertices, const MatrixX3f& normals, const MatrixX3i& faces);

 private:
  ShadowMap map_;
  std::vector<float> openness_, whole_;
};

}  // namespace bodyloom
