// SPDX-License-Identifier: Apache-2.0
#include "geometry/mesh/mesh_adjacency.h"

#include <algorithm>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {

MeshAdjacency BuildMeshAdjacency(const MatrixX3i& faces, int num_vertices) {
  MeshAdjacency mesh;
  const int num_corners = 3 * static_cast<int>(faces.rows());
  const int* vertex_of = faces.data();
  mesh.corner_begin.assign(num_vertices + 1, 0);
  for (int c = 0; c < num_corners; ++c) {
    BODYLOOM_CHECK(vertex_of[c] >= 0 && vertex_of[c] < num_vertices, "face ", c / 3, " names vertex ", vertex_of[c],
                   ", expected 0..", num_vertices - 1);
    ++mesh.corner_begin[vertex_of[c] + 1];
  }
  for (int v = 0; v < num_vertices; ++v) mesh.corner_begin[v + 1] += mesh.corner_begin[v];
  mesh.corner.resize(num_corners);
  std::vector<int> next(mesh.corner_begin.begin(), mesh.corner_begin.end() - 1);
  for (int c = 0; c < num_corners; ++c) mesh.corner[next[vertex_of[c]]++] = c;

  // Half-edges in the order of their two vertices: those of one edge lie side by side.
  std::vector<std::pair<std::pair<int, int>, int>> edges;
  edges.reserve(num_corners);
  for (int c = 0; c < num_corners; ++c) {
    const int a = vertex_of[c], b = vertex_of[c - c % 3 + (c + 1) % 3];
    edges.push_back({{std::min(a, b), std::max(a, b)}, c});
  }
  std::sort(edges.begin(), edges.end());
  mesh.opposite.assign(num_corners, -1);
  for (size_t i = 0, end = 0; i < edges.size(); i = end) {
    while (end < edges.size() && edges[end].first == edges[i].first) ++end;
    if (end - i == 2) {
      mesh.opposite[edges[i].second] = edges[i + 1].second;
      mesh.opposite[edges[i + 1].second] = edges[i].second;
    } else {
      ++(end - i == 1 ? mesh.num_boundary_edges : mesh.num_non_manifold_edges);
    }
  }
  return mesh;
}

}  // namespace bodyloom
