// SPDX-License-Identifier: Apache-2.0
/// Area-weighted normals of meshes given in double and wherever they stand, as pictures need them: the vertices are
/// taken relative to the first one, then geometry/normals.h.
#pragma once

#include <memory>
#include <utility>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/normals.h"

namespace bodyloom {

/// For meshes that come one after another with the same faces, as the frames of a clip do: who meets whom is worked out
/// once. Not for use by two threads at once.
class VertexNormalsOfMesh {
 public:
  VertexNormalsOfMesh() = default;
  /// Of meshes with these faces for the first; so several of these work it out once.
  explicit VertexNormalsOfMesh(std::shared_ptr<const MeshNormals> mesh) : mesh_(std::move(mesh)) {}

  /// V×3 unit normals, valid until the next call. Throws std::invalid_argument as MeshNormals does.
  const MatrixX3f& Compute(const MatrixX3d& vertices, const MatrixX3i& faces);

 private:
  std::shared_ptr<const MeshNormals> mesh_;
  NormalScratch scratch_;
  MatrixX3f relative_, normals_;
};

/// The same for a single mesh.
MatrixX3f VertexNormals(const MatrixX3d& vertices, const MatrixX3i& faces);

}  // namespace bodyloom
