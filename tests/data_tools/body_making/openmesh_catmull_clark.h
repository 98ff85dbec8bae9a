// SPDX-License-Identifier: Apache-2.0
/// OpenMesh's Catmull–Clark subdivider as an independent reference for data_tools/body_making/subdivision.h, and a
/// geometric comparison of the two (OpenMesh has its own order of vertices and faces).
#pragma once

#include <string>
#include <vector>

#include "data_tools/body_making/cage.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

struct QuadMesh {
  MatrixX3d vertices;  ///< V×3 metres
  std::vector<Quad> quads;
};

/// Applies `levels` rounds of OpenMesh::Subdivider::Uniform::CatmullClarkT. Throws std::invalid_argument when OpenMesh
/// rejects a quad (not manifold).
QuadMesh SubdivideByOpenMesh(const QuadMesh& cage, int levels);

/// Difference of two quad meshes with vertices matched to the nearest of the other mesh.
struct MeshAgreement {
  double max_vertex_distance_m = 0;  ///< largest distance between matched vertices
  int unmatched_vertices = 0;        ///< without a free partner within the tolerance
  int unmatched_quads = 0;  ///< quads whose matched corners are no quad of the other mesh (cyclic order counts)
  [[nodiscard]] bool Equal() const { return unmatched_vertices == 0 && unmatched_quads == 0; }
  [[nodiscard]] std::string BriefReport() const;
};

MeshAgreement CompareByGeometry(const QuadMesh& a, const QuadMesh& b, double tolerance_m);

}  // namespace bodyloom
