// SPDX-License-Identifier: Apache-2.0
/// OpenMesh's Catmull–Clark subdivider as an independent judge of data_tools/body_making/subdivision.h, and the
/// comparison of the two by geometry (OpenMesh numbers vertices and faces in an order of its own).
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

/// `levels` rounds of OpenMesh::Subdivider::Uniform::CatmullClarkT. Throws std::invalid_argument when OpenMesh refuses
/// a quad (not manifold).
QuadMesh SubdivideByOpenMesh(const QuadMesh& cage, int levels);

/// How two quad meshes differ when vertices are matched to the nearest of the other mesh.
struct MeshAgreement {
  double max_vertex_distance_m = 0;  ///< largest distance between matched vertices
  int unmatched_vertices = 0;        ///< vertices whose nearest partner is taken already or farther than the tolerance
  int unmatched_quads = 0;  ///< quads whose matched corners are no quad of the other mesh (cyclic order counts)
  [[nodiscard]] bool Equal() const { return unmatched_vertices == 0 && unmatched_quads == 0; }
  [[nodiscard]] std::string BriefReport() const;
};

MeshAgreement CompareByGeometry(const QuadMesh& a, const QuadMesh& b, double tolerance_m);

}  // namespace bodyloom
