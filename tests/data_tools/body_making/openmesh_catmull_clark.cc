// SPDX-License-Identifier: Apache-2.0
#include "tests/data_tools/body_making/openmesh_catmull_clark.h"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/CatmullClarkT.hh>
#include <algorithm>
#include <set>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::PolyMesh_ArrayKernelT<Traits>;

/// Rotates the cycle so that the smallest index comes first; the orientation stays.
Quad Canonical(Quad quad) {
  std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
  return quad;
}

}  // namespace

QuadMesh SubdivideByOpenMesh(const QuadMesh& cage, int levels) {
  Mesh mesh;
  std::vector<Mesh::VertexHandle> handles;
  for (Eigen::Index v = 0; v < cage.vertices.rows(); ++v) {
    handles.push_back(mesh.add_vertex({cage.vertices(v, 0), cage.vertices(v, 1), cage.vertices(v, 2)}));
  }
  for (const Quad& quad : cage.quads) {
    for (int v : quad) BODYLOOM_CHECK(v >= 0 && v < cage.vertices.rows(), "a quad names vertex ", v);
    const auto face = mesh.add_face(handles[quad[0]], handles[quad[1]], handles[quad[2]], handles[quad[3]]);
    BODYLOOM_CHECK(face.is_valid(), "OpenMesh refuses a quad: the mesh is not manifold");
  }
  OpenMesh::Subdivider::Uniform::CatmullClarkT<Mesh, double> subdivider;
  subdivider.attach(mesh);
  subdivider(static_cast<size_t>(levels));
  subdivider.detach();

  QuadMesh fine;
  fine.vertices.resize(static_cast<Eigen::Index>(mesh.n_vertices()), 3);
  for (const auto vertex : mesh.vertices()) {
    const Mesh::Point& point = mesh.point(vertex);
    fine.vertices.row(vertex.idx()) << point[0], point[1], point[2];
  }
  for (const auto face : mesh.faces()) {
    Quad quad{};
    int corners = 0;
    for (const auto vertex : mesh.fv_range(face)) {
      if (corners < 4) quad[corners] = vertex.idx();
      ++corners;
    }
    BODYLOOM_CHECK(corners == 4, "OpenMesh made a face of ", corners, " corners, expected 4");
    fine.quads.push_back(quad);
  }
  return fine;
}

MeshAgreement CompareByGeometry(const QuadMesh& a, const QuadMesh& b, double tolerance_m) {
  // Vertices of b sorted by x: the partners of a vertex lie in a short run of them.
  std::vector<int> by_x(b.vertices.rows());
  for (size_t i = 0; i < by_x.size(); ++i) by_x[i] = static_cast<int>(i);
  std::sort(by_x.begin(), by_x.end(), [&](int i, int j) { return b.vertices(i, 0) < b.vertices(j, 0); });
  MeshAgreement agreement;
  std::vector<int> partner(a.vertices.rows(), -1);
  std::vector<bool> taken(b.vertices.rows(), false);
  for (Eigen::Index v = 0; v < a.vertices.rows(); ++v) {
    const double x = a.vertices(v, 0);
    auto it = std::lower_bound(by_x.begin(), by_x.end(), x - tolerance_m,
                               [&](int i, double value) { return b.vertices(i, 0) < value; });
    double best = tolerance_m;
    for (; it != by_x.end() && b.vertices(*it, 0) <= x + tolerance_m; ++it) {
      const double distance = (b.vertices.row(*it) - a.vertices.row(v)).norm();
      if (distance <= best) {
        best = distance;
        partner[v] = *it;
      }
    }
    if (partner[v] < 0 || taken[partner[v]]) {
      ++agreement.unmatched_vertices;
      continue;
    }
    taken[partner[v]] = true;
    agreement.max_vertex_distance_m = std::max(agreement.max_vertex_distance_m, best);
  }
  agreement.unmatched_vertices += static_cast<int>(std::max<Eigen::Index>(0, b.vertices.rows() - a.vertices.rows()));

  std::multiset<Quad> quads_of_b;
  for (const Quad& quad : b.quads) quads_of_b.insert(Canonical(quad));
  for (const Quad& quad : a.quads) {
    Quad matched;
    for (int k = 0; k < 4; ++k) matched[k] = partner[quad[k]];
    const auto found = quads_of_b.find(Canonical(matched));
    if (found == quads_of_b.end()) {
      ++agreement.unmatched_quads;
    } else {
      quads_of_b.erase(found);
    }
  }
  agreement.unmatched_quads += static_cast<int>(quads_of_b.size());
  return agreement;
}

std::string MeshAgreement::BriefReport() const {
  return Concatenate("largest distance of matched vertices ", max_vertex_distance_m, " m, ", unmatched_vertices,
                     " vertices and ", unmatched_quads, " quads without partner");
}

}  // namespace bodyloom
