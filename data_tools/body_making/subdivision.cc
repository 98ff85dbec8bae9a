// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/subdivision.h"

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <array>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kLevels = 2;

/// Vertices stay, face points are the mean of a quad's corners, edge points of an edge's ends.
SparseRows HalvingOf(int num_coarse, const std::vector<Quad>& coarse_quads, const SubdivisionLevel& level) {
  std::vector<Eigen::Triplet<double>> entries;
  int v = 0;
  for (; v < num_coarse; ++v) entries.emplace_back(v, v, 1);
  for (const Quad& quad : coarse_quads) {
    for (const int corner : quad) entries.emplace_back(v, corner, 0.25);
    ++v;
  }
  for (const Edge& edge : level.edges) {
    for (const int end : edge) entries.emplace_back(v, end, 0.5);
    ++v;
  }
  SparseRows halving(v, num_coarse);
  halving.setFromTriplets(entries.begin(), entries.end());
  return halving;
}

using HalfEdges = OpenMesh::PolyConnectivity;

/// Edges are numbered in the order in which they are first met, faces as the quads.
HalfEdges BuildHalfEdges(int num_vertices, const std::vector<Quad>& quads) {
  static const bool quiet = (omerr().disable(), true);  // it prints what add_face() refuses
  HalfEdges mesh;
  for (int v = 0; quiet && v < num_vertices; ++v) mesh.add_vertex();
  for (size_t f = 0; f < quads.size(); ++f) {
    std::array<OpenMesh::VertexHandle, 4> corners;
    for (int k = 0; k < 4; ++k) {
      const int a = quads[f][k], b = quads[f][(k + 1) % 4];
      BODYLOOM_CHECK(a >= 0 && a < num_vertices, "quad ", f, " names vertex ", a, ", expected 0..", num_vertices - 1);
      BODYLOOM_CHECK(a != b && a != quads[f][(k + 2) % 4], "quad ", f, " names vertex ", a, " twice");
      corners[k] = OpenMesh::VertexHandle(a);
    }
    BODYLOOM_CHECK(mesh.add_face(corners.data(), 4).is_valid(), "quad ", f,
                   " closes no fan of an oriented manifold: an edge of it is shared by more than two quads or runs the "
                   "same way in both, or quads meet in a vertex alone");
  }
  for (const auto h : mesh.halfedges()) {
    BODYLOOM_CHECK(!mesh.is_boundary(h), "edge ", mesh.from_vertex_handle(h).idx(), "-", mesh.to_vertex_handle(h).idx(),
                   " has one quad, expected a closed mesh");
  }
  return mesh;
}

int FindEdge(const HalfEdges& mesh, int a, int b) {
  const auto half_edge = mesh.find_halfedge(OpenMesh::VertexHandle(a), OpenMesh::VertexHandle(b));
  return half_edge.is_valid() ? mesh.edge_handle(half_edge).idx() : -1;
}

}  // namespace

SubdivisionLevel SubdivideCatmullClark(int num_vertices, const std::vector<Quad>& quads) {
  const HalfEdges mesh = BuildHalfEdges(num_vertices, quads);
  const int V = num_vertices;
  const int F = static_cast<int>(quads.size());
  const int E = static_cast<int>(mesh.n_edges());
  SubdivisionLevel level;
  for (const auto edge : mesh.edges()) {
    const auto along = mesh.halfedge_handle(edge, 0);  // as the quad runs that met it first
    level.edges.push_back({mesh.from_vertex_handle(along).idx(), mesh.to_vertex_handle(along).idx()});
  }
  std::vector<int> valence(V);
  for (int v = 0; v < V; ++v) {
    valence[v] = static_cast<int>(mesh.valence(OpenMesh::VertexHandle(v)));
    BODYLOOM_CHECK(valence[v] >= 3, "vertex ", v, " has ", valence[v], " edges, expected 3 or more");
  }

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
    for (int end : level.edges[e]) {
      const double midpoint_share = 2.0 / (static_cast<double>(valence[end]) * valence[end]);
      for (int other : level.edges[e]) entries.emplace_back(end, other, 0.5 * midpoint_share);
      entries.emplace_back(V + F + e, end, 0.25);
    }
    for (int side = 0; side < 2; ++side) {
      const int f = mesh.face_handle(mesh.halfedge_handle(OpenMesh::EdgeHandle(e), side)).idx();
      for (int corner : quads[f]) entries.emplace_back(V + F + e, corner, 0.25 * 0.25);
    }
  }

  level.fine_from_coarse.resize(V + F + E, V);
  level.fine_from_coarse.setFromTriplets(entries.begin(), entries.end());
  level.quads.reserve(4 * F);
  for (int f = 0; f < F; ++f) {
    for (int k = 0; k < 4; ++k) {
      const int corner = quads[f][k], next = quads[f][(k + 1) % 4], previous = quads[f][(k + 3) % 4];
      level.quads.push_back(
          {corner, V + F + FindEdge(mesh, corner, next), V + f, V + F + FindEdge(mesh, previous, corner)});
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
  const HalfEdges mesh = BuildHalfEdges(V, coarse_quads);
  for (const int image : coarse_mirror)
    BODYLOOM_CHECK(image >= 0 && image < V, "vertex ", image, " is no mirror image");
  std::vector<int> mirror = coarse_mirror;
  for (int f = 0; f < F; ++f) {
    Quad image;  // a reflection turns the quad round
    for (int k = 0; k < 4; ++k) image[k] = coarse_mirror[coarse_quads[f][3 - k]];
    const auto side = mesh.find_halfedge(OpenMesh::VertexHandle(image[0]), OpenMesh::VertexHandle(image[1]));
    BODYLOOM_CHECK(side.is_valid(), "quad ", f, " has no mirror image");
    auto along = static_cast<OpenMesh::HalfedgeHandle>(side);
    for (int k = 0; k < 4; ++k, along = mesh.next_halfedge_handle(along)) {
      BODYLOOM_CHECK(mesh.from_vertex_handle(along).idx() == image[k], "quad ", f, " has no mirror image");
    }
    mirror.push_back(V + mesh.face_handle(side).idx());
  }
  for (size_t e = 0; e < level.edges.size(); ++e) {
    const int image = FindEdge(mesh, coarse_mirror[level.edges[e][0]], coarse_mirror[level.edges[e][1]]);
    BODYLOOM_CHECK(image >= 0, "edge ", e, " has no mirror image");
    mirror.push_back(V + F + image);
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

RefinedCage RefineCage(const Cage& cage) {
  RefinedCage refined;
  refined.quads = cage.quads;
  refined.mirror = cage.mirror;
  const auto num_cage = static_cast<Eigen::Index>(cage.mirror.size());
  refined.fine_from_cage.resize(num_cage, num_cage);
  refined.fine_from_cage.setIdentity();
  refined.bilinear_from_cage = refined.fine_from_cage;
  for (int level = 0; level < kLevels; ++level) {
    const int num_coarse = static_cast<int>(refined.mirror.size());
    const SubdivisionLevel finer = SubdivideCatmullClark(num_coarse, refined.quads);
    refined.mirror = MirrorOfSubdivision(refined.mirror, refined.quads, finer);
    refined.bilinear_from_cage = SparseRows(HalvingOf(num_coarse, refined.quads, finer) * refined.bilinear_from_cage);
    refined.quads = finer.quads;
    refined.fine_from_cage = SparseRows(finer.fine_from_coarse * refined.fine_from_cage);
  }
  refined.num_left_quads = kQuadsPerCageQuad * cage.num_left_quads;
  std::vector<bool> is_left(refined.mirror.size(), false);
  for (int q = 0; q < refined.num_left_quads; ++q) {
    for (int v : refined.quads[q]) is_left[v] = true;
  }
  for (size_t v = 0; v < is_left.size(); ++v) {
    if (is_left[v]) refined.left_vertices.push_back(static_cast<int>(v));
  }
  return refined;
}

void FillWeights(const RefinedCage& refined, const std::vector<int>& joint_mirror,
                 const std::vector<WeightedIndices>& left_weights, BodyModelData* body) {
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t i = 0; i < refined.left_vertices.size(); ++i) {
    const int v = refined.left_vertices[i];
    for (const auto& [joint, weight] : left_weights[i]) {
      entries.emplace_back(v, joint, weight);
      if (refined.mirror[v] != v) entries.emplace_back(refined.mirror[v], joint_mirror[joint], weight);
    }
  }
  body->weights.resize(static_cast<Eigen::Index>(refined.mirror.size()),
                       static_cast<Eigen::Index>(joint_mirror.size()));
  body->weights.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace bodyloom
