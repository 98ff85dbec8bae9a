// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/speed/peer_normals.h"

#ifdef BODYLOOM_BENCH_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Surface_mesh.h>

namespace bodyloom {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

class Peer : public PeerNormals {
 public:
  Peer(const MatrixX3i& faces, const MatrixX3d& vertices) {
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      mesh_.add_vertex({vertices(v, 0), vertices(v, 1), vertices(v, 2)});
    }
    for (Eigen::Index f = 0; f < faces.rows(); ++f) {
      mesh_.add_face(Mesh::Vertex_index(faces(f, 0)), Mesh::Vertex_index(faces(f, 1)), Mesh::Vertex_index(faces(f, 2)));
    }
    normals_ = mesh_.add_property_map<Mesh::Vertex_index, Kernel::Vector_3>("v:normal", CGAL::NULL_VECTOR).first;
  }
  void Compute(const MatrixX3d& vertices, MatrixX3d* normals) override {
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      mesh_.point(Mesh::Vertex_index(v)) = {vertices(v, 0), vertices(v, 1), vertices(v, 2)};
    }
    CGAL::Polygon_mesh_processing::compute_vertex_normals(mesh_, normals_);
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      const Kernel::Vector_3& n = normals_[Mesh::Vertex_index(v)];
      normals->row(v) << n.x(), n.y(), n.z();
    }
  }

 private:
  Mesh mesh_;
  Mesh::Property_map<Mesh::Vertex_index, Kernel::Vector_3> normals_;
};

}  // namespace

std::unique_ptr<PeerNormals> CgalNormals(const MatrixX3i& faces, const MatrixX3d& vertices) {
  return std::make_unique<Peer>(faces, vertices);
}

}  // namespace bodyloom
#else
namespace bodyloom {
std::unique_ptr<PeerNormals> CgalNormals(const MatrixX3i&, const MatrixX3d&) { return nullptr; }
}  // namespace bodyloom
#endif
