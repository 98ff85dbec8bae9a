// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/geometry/vertex_normals.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

const MatrixX3f& VertexNormalsOfMesh::Compute(const MatrixX3d& vertices, const MatrixX3i& faces) {
  BODYLOOM_CHECK(vertices.rows() > 0, "vertex normals: the mesh has no vertices");
  const auto is_same = [&](const MatrixX3i& known) { return known.rows() == faces.rows() && known == faces; };
  if (!mesh_ || mesh_->num_vertices() != vertices.rows() || !is_same(mesh_->faces())) {
    mesh_ = std::make_shared<const MeshNormals>(faces, static_cast<int>(vertices.rows()));
  }
  relative_ = (vertices.rowwise() - vertices.row(0)).cast<float>();
  normals_.resize(vertices.rows(), 3);
  mesh_->Compute({relative_.data(), static_cast<size_t>(relative_.size())},
                 {normals_.data(), static_cast<size_t>(normals_.size())}, &scratch_);
  return normals_;
}

MatrixX3f VertexNormals(const MatrixX3d& vertices, const MatrixX3i& faces) {
  return VertexNormalsOfMesh().Compute(vertices, faces);
}

}  // namespace bodyloom
