// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/subdivision.h"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Undirected edges in order of first appearance, with the quads beside them.
struct EdgeTable {
  std::vector<Edge> edges;
  std::vector<std::array<int, 2>> faces;  // −1: none yet
  std::unordered_map<int64_t, int> index_of;

  static int64_t Key(int a, int b) { return (static_cast<int64_t>(std::min(a, b)) << 32) | std::max(a, b); }

  [[nodiscard]] int Find(int a, int b) const {
    const auto it = index_of.find(Key(a, b));
    return it == index_of.end() ? -1 : it->second;
  }
};

EdgeTable BuildEdges(int num_vertices, const std::vector<Quad>& quads) {
  EdgeTable table;
  table.index_of.reserve(2 * quads.size());
  for (size_t f = 0; f < quads.size(); ++f) {
    for (int k = 0; k < 4; ++k) {
      const int a = quads[f][k], b = quads[f][(k + 1) % 4];
      BODYLOOM_CHECK(a >= 0 && a < num_vertices, "quad ", f, " names vertex ", a, ", expected 0..", num_vertices - 1);
      const auto [it, is_new] = table.index_of.emplace(EdgeTable::Key(a, b), static_cast<int>(table.edges.size()));
      if (is_new) {
        table.edges.push_back({a, b});
        table.faces.push_back({static_cast<int>(f), -1});
        continue;
      }
      std::array<int, 2>& faces = table.faces[it->second];
      BODYLOOM_CHECK(faces[1] < 0 && table.edges[it->second][0] == b, "edge ", a, "-", b, " of quad ", f,
                     " is shared by more than two quads or runs the same way in both");
      faces[1] = static_cast<int>(f);
    }
  }
  for (size_t e = 0; e < table.edges.size(); ++e) {
    BODYLOOM_CHECK(table.faces[e][1] >= 0, "edge ", table.edges[e][0], "-", table.edges[e][1],
                   " has one quad, expected a closed mesh");
  }
  return table;
}

}  // namespace

SubdivisionLevel SubdivideCatmullClark(int num_vertices, const std::vector<Quad>& quads) {
  const EdgeTable table = BuildEdges(num_vertices, quads);
  const int V = num_vertices;
  const int F = static_cast<int>(quads.size());
  const int E = static_cast<int>(table.edges.size());
  std::vector<int> valence(V, 0);
  for (const Edge& edge : table.edges) {
    ++valence[edge[0]];
    ++valence[edge[1]];
  }
  for (int v = 0; v < V; ++v)
    BODYLOOM_CHECK(valence[v] >= 3, "vertex ", v, " has ", valence[v], " edges, expected 3 or more");

  using Triplet = Eigen::Triplet<double>;
  std::vector<Triplet> entries;  // repeated (row, column) pairs are summed
  entries.reserve(16 * F + 4 * F + 10 * E);
  for (int v = 0; v < V; ++v) entries.emplace_back(v, v, (valence[v] - 3.0) / valence[v]);
  for (int f = 0; f < F; ++f) {
    for (int corner : quads[f]) {
      entries.emplace_back(V + f, corner, 0.25);
      const double face_share = 1.0 / (static_cast<double>(valence[corner]) * valence[corner]);
      for (int other : quads[f]) entries.emplace_back(corner, other, 0.25 * face_share);
    }
  }
  for (int e = 0; e < E; ++e) {
    for (int end : table.edges[e]) {
      const double midpoint_share = 2.0 / (static_cast<double>(valence[end]) * valence[end]);
      for (int other : table.edges[e]) entries.emplace_back(end, other, 0.5 * midpoint_share);
      entries.emplace_back(V + F + e, end, 0.25);
    }
    for (int f : table.faces[e]) {
      for (int corner : quads[f]) entries.emplace_back(V + F + e, corner, 0.25 * 0.25);
    }
  }

  SubdivisionLevel level;
  level.edges = table.edges;
  level.fine_from_coarse.resize(V + F + E, V);
  level.fine_from_coarse.setFromTriplets(entries.begin(), entries.end());
  level.quads.reserve(4 * F);
  for (int f = 0; f < F; ++f) {
    for (int k = 0; k < 4; ++k) {
      const int corner = quads[f][k], next = quads[f][(k + 1) % 4], previous = quads[f][(k + 3) % 4];
      level.quads.push_back({corner, V + F + table.Find(corner, next), V + f, V + F + table.Find(previous, corner)});
    }
  }
  return level;
}

std::vector<int> MirrorOfSubdivision(const std::vector<int>& coarse_mirror, const std::vector<Quad>& coarse_quads,
                                     const SubdivisionLevel& level) {
  const int V = static_cast<int>(coarse_mirror.size());
  const int F = static_cast<int>(coarse_quads.size());
  BODYLOOM_CHECK(level.fine_from_coarse.cols() == V, "mirror map of ", V, " vertices, the level refines ",
                 level.fine_from_coarse.cols());
  std::map<Quad, int> face_of_corners;
  for (int f = 0; f < F; ++f) {
    Quad corners = coarse_quads[f];
    std::sort(corners.begin(), corners.end());
    face_of_corners[corners] = f;
  }
  std::unordered_map<int64_t, int> edge_of_ends;
  for (size_t e = 0; e < level.edges.size(); ++e) {
    edge_of_ends[EdgeTable::Key(level.edges[e][0], level.edges[e][1])] = static_cast<int>(e);
  }
  std::vector<int> mirror = coarse_mirror;
  for (int f = 0; f < F; ++f) {
    Quad corners;
    for (int k = 0; k < 4; ++k) corners[k] = coarse_mirror[coarse_quads[f][k]];
    std::sort(corners.begin(), corners.end());
    const auto found = face_of_corners.find(corners);
    BODYLOOM_CHECK(found != face_of_corners.end(), "quad ", f, " has no mirror image");
    mirror.push_back(V + found->second);
  }
  for (size_t e = 0; e < level.edges.size(); ++e) {
    const auto found =
        edge_of_ends.find(EdgeTable::Key(coarse_mirror[level.edges[e][0]], coarse_mirror[level.edges[e][1]]));
    BODYLOOM_CHECK(found != edge_of_ends.end(), "edge ", e, " has no mirror image");
    mirror.push_back(V + F + found->second);
  }
  return mirror;
}

MatrixX3i TrianglesOfQuads(const std::vector<Quad>& quads) {
  MatrixX3i triangles(2 * static_cast<Eigen::Index>(quads.size()), 3);
  for (size_t q = 0; q < quads.size(); ++q) {
    const Quad& quad = quads[q];
    triangles.row(2 * static_cast<Eigen::Index>(q)) << quad[0], quad[1], quad[2];
    triangles.row(2 * static_cast<Eigen::Index>(q) + 1) << quad[0], quad[2], quad[3];
  }
  return triangles;
}

}  // namespace bodyloom
