// SPDX-License-Identifier: Apache-2.0
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "benchmarks/speed/peer_normals.h"

namespace bodyloom {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3f;
  using Normal = OpenMesh::Vec3f;
};

class Peer : public PeerNormals {
 public:
  Peer(const MatrixX3i& faces, const MatrixX3d& vertices) {
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) mesh_.add_vertex(Point(vertices, v));
    for (Eigen::Index f = 0; f < faces.rows(); ++f) {
      mesh_.add_face(mesh_.vertex_handle(faces(f, 0)), mesh_.vertex_handle(faces(f, 1)),
                     mesh_.vertex_handle(faces(f, 2)));
    }
    mesh_.request_face_normals();
  }
  void Compute(const MatrixX3d& vertices, MatrixX3d* normals) override {
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      mesh_.set_point(mesh_.vertex_handle(static_cast<unsigned>(v)), Point(vertices, v));
    }
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      OpenMesh::Vec3f n;
      mesh_.calc_vertex_normal_correct(mesh_.vertex_handle(static_cast<unsigned>(v)), n);
      normals->row(v) = Eigen::RowVector3d(n[0], n[1], n[2]).normalized();
    }
  }

 private:
  static OpenMesh::Vec3f Point(const MatrixX3d& vertices, Eigen::Index v) {
    return {static_cast<float>(vertices(v, 0)), static_cast<float>(vertices(v, 1)), static_cast<float>(vertices(v, 2))};
  }
  OpenMesh::TriMesh_ArrayKernelT<Traits> mesh_;
};

}  // namespace

std::unique_ptr<PeerNormals> OpenMeshNormals(const MatrixX3i& faces, const MatrixX3d& vertices) {
  return std::make_unique<Peer>(faces, vertices);
}

}  // namespace bodyloom
