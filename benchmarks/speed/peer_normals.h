// SPDX-License-Identifier: Apache-2.0
/// Vertex normals by other libraries for comparison; each builds its mesh once, and only the normals are timed.
#pragma once

#include <memory>

#include "geometry/math/arrays.h"

namespace bodyloom {

class PeerNormals {
 public:
  virtual ~PeerNormals() = default;
  virtual void Compute(const MatrixX3d& vertices, MatrixX3d* normals) = 0;
};

/// OpenMesh, area-weighted (calc_vertex_normal_correct).
std::unique_ptr<PeerNormals> OpenMeshNormals(const MatrixX3i& faces, const MatrixX3d& vertices);
/// CGAL's compute_vertex_normals; null when built without CGAL.
std::unique_ptr<PeerNormals> CgalNormals(const MatrixX3i& faces, const MatrixX3d& vertices);

}  // namespace bodyloom
