// SPDX-License-Identifier: Apache-2.0
#include "geometry/mesh/mesh_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/mesh/mesh_adjacency.h"

namespace bodyloom {
namespace {

constexpr double kNoOutside = 1e-3;  // |volume| / area^1.5 below which a surface has no inside

/// Disjoint sets that are merged pairwise.
class JoinedSets {
 public:
  explicit JoinedSets(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int Find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(int a, int b) { parent_[std::max(Find(a), Find(b))] = std::min(Find(a), Find(b)); }

 private:
  std::vector<int> parent_;
};

double SmallestHeight(const MatrixX3d& vertices, const Eigen::RowVector3i& face) {
  const Eigen::RowVector3d a = vertices.row(face[0]), b = vertices.row(face[1]), c = vertices.row(face[2]);
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return longest > 0 ? (b - a).cross(c - a).norm() / longest : 0;
}

void FindSuperfluousFaces(const MatrixX3d& vertices, const MatrixX3i& faces, double flat_height_m,
                          CheckMeshResult* result) {
  std::map<std::array<int, 3>, int> seen;
  for (int f = 0; f < faces.rows(); ++f) {
    std::array<int, 3> key = {faces(f, 0), faces(f, 1), faces(f, 2)};
    std::sort(key.begin(), key.end());
    if (key[0] == key[1] || key[1] == key[2]) {
      result->repeated_corner_faces.push_back(f);
    } else if (!seen.emplace(key, f).second) {
      result->duplicate_faces.push_back(f);
    } else if (SmallestHeight(vertices, faces.row(f)) <= flat_height_m) {
      result->flat_faces.push_back(f);
    }
  }
}

/// In the order of the vertices: each joins the first one that stands for a place within reach.
void FindDuplicateVertices(const MatrixX3d& vertices, double reach_m, CheckMeshResult* result) {
  const int V = static_cast<int>(vertices.rows());
  std::vector<int> by_x(V);
  std::iota(by_x.begin(), by_x.end(), 0);
  std::sort(by_x.begin(), by_x.end(), [&](int i, int j) { return vertices(i, 0) < vertices(j, 0); });
  std::vector<std::vector<int>> earlier(V);  // vertices of smaller number within reach
  for (int i = 0; i < V; ++i) {
    for (int j = i + 1; j < V && vertices(by_x[j], 0) - vertices(by_x[i], 0) <= reach_m; ++j) {
      if ((vertices.row(by_x[i]) - vertices.row(by_x[j])).norm() > reach_m) continue;
      earlier[std::max(by_x[i], by_x[j])].push_back(std::min(by_x[i], by_x[j]));
    }
  }
  std::vector<bool> stands(V, true);
  for (int v = 0; v < V; ++v) {
    std::sort(earlier[v].begin(), earlier[v].end());
    const auto first = std::find_if(earlier[v].begin(), earlier[v].end(), [&](int u) { return stands[u]; });
    if (first == earlier[v].end()) continue;
    stands[v] = false;
    result->duplicate_vertices.push_back({v, *first});
  }
}

/// Edges, fans and components of the faces that are left.
class Topology {
 public:
  Topology(const MatrixX3d& vertices, const MatrixX3i& faces, std::vector<int> number_of_face)
      : vertices_(vertices),
        faces_(faces),
        number_of_face_(std::move(number_of_face)),
        mesh_(BuildMeshAdjacency(faces, static_cast<int>(vertices.rows()))) {}

  void Run(CheckMeshResult* result) {
    FindIrregularEdges(result);
    FindNonManifoldVertices(result);
    FindBoundaryLoops(result);
    FindComponents(result);
  }

 private:
  [[nodiscard]] int From(int half_edge) const { return faces_.data()[half_edge]; }
  [[nodiscard]] int To(int half_edge) const { return faces_.data()[half_edge - half_edge % 3 + (half_edge + 1) % 3]; }
  [[nodiscard]] std::array<int, 2> EdgeOf(int half_edge) const {
    return {std::min(From(half_edge), To(half_edge)), std::max(From(half_edge), To(half_edge))};
  }

  void FindIrregularEdges(CheckMeshResult* result) {
    std::map<std::array<int, 2>, std::vector<int>> irregular;
    for (int h = 0; h < static_cast<int>(mesh_.opposite.size()); ++h) {
      if (mesh_.opposite[h] < 0) irregular[EdgeOf(h)].push_back(h);
    }
    for (const auto& [edge, half_edges] : irregular) {
      if (half_edges.size() == 1) {
        boundary_.push_back(half_edges[0]);
      } else {
        result->non_manifold_edges.push_back(edge);
        crowded_.push_back(half_edges);
      }
    }
    result->boundary_edges = static_cast<int>(boundary_.size());
  }

  void FindNonManifoldVertices(CheckMeshResult* result) {
    // Corner c of a face is joined with its neighbours' corners at the same vertex.
    JoinedSets fans(static_cast<int>(faces_.size()));
    const auto corner_at = [&](int face, int vertex) {
      int c = 3 * face;
      while (From(c) != vertex) ++c;
      return c;
    };
    const auto join = [&](int h, int k) {
      for (const int vertex : EdgeOf(h)) fans.Join(corner_at(h / 3, vertex), corner_at(k / 3, vertex));
    };
    for (int h = 0; h < static_cast<int>(mesh_.opposite.size()); ++h) {
      if (mesh_.opposite[h] > h) join(h, mesh_.opposite[h]);
    }
    for (const std::vector<int>& half_edges : crowded_) {
      for (const int h : half_edges) join(half_edges[0], h);
    }
    for (int v = 0; v + 1 < static_cast<int>(mesh_.corner_begin.size()); ++v) {
      for (int i = mesh_.corner_begin[v] + 1; i < mesh_.corner_begin[v + 1]; ++i) {
        if (fans.Find(mesh_.corner[i]) == fans.Find(mesh_.corner[mesh_.corner_begin[v]])) continue;
        result->non_manifold_vertices.push_back(v);
        break;
      }
    }
  }

  /// Boundary edges end to end, whichever way their faces run.
  void FindBoundaryLoops(CheckMeshResult* result) {
    std::map<int, std::vector<int>> at;  // vertex → indices of boundary_
    for (int i = 0; i < static_cast<int>(boundary_.size()); ++i) {
      for (const int vertex : EdgeOf(boundary_[i])) at[vertex].push_back(i);
    }
    loop_of_edge_.assign(boundary_.size(), -1);
    for (int start = 0; start < static_cast<int>(boundary_.size()); ++start) {
      if (loop_of_edge_[start] >= 0) continue;
      const int loop = static_cast<int>(result->boundary_loops.size());
      std::vector<int>& vertices = result->boundary_loops.emplace_back();
      for (int edge = start, vertex = From(boundary_[start]); edge >= 0;) {
        loop_of_edge_[edge] = loop;
        vertices.push_back(vertex);
        vertex = From(boundary_[edge]) == vertex ? To(boundary_[edge]) : From(boundary_[edge]);
        const std::vector<int>& next = at.at(vertex);
        const auto free = std::find_if(next.begin(), next.end(), [&](int i) { return loop_of_edge_[i] < 0; });
        edge = free == next.end() ? -1 : *free;
      }
    }
    loop_means_.resize(static_cast<Eigen::Index>(result->boundary_loops.size()), 3);
    for (size_t loop = 0; loop < result->boundary_loops.size(); ++loop) {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (const int v : result->boundary_loops[loop]) sum += vertices_.row(v);
      loop_means_.row(static_cast<Eigen::Index>(loop)) = sum / static_cast<double>(result->boundary_loops[loop].size());
    }
  }

  void FindComponents(CheckMeshResult* result) {
    const int F = static_cast<int>(faces_.rows());
    std::vector<int> boundary_of(3 * size_t(F), -1);  // half-edge → index of boundary_
    for (size_t i = 0; i < boundary_.size(); ++i) boundary_of[boundary_[i]] = static_cast<int>(i);
    std::vector<int> turn(F, -1);  // 1: runs against the component's first face
    for (int first = 0; first < F; ++first) {
      if (turn[first] >= 0) continue;
      MeshComponent component;
      component.is_closed = component.is_orientable = true;
      std::vector<int> members = {first};
      turn[first] = 0;
      for (size_t i = 0; i < members.size(); ++i) {
        for (int h = 3 * members[i]; h < 3 * members[i] + 3; ++h) {
          const int across = mesh_.opposite[h];
          if (across < 0) {
            component.is_closed = false;
            continue;
          }
          const int same_way = From(h) == From(across) ? 1 : 0;
          if (h < across) result->inconsistent_edges += same_way;
          const int wanted = turn[members[i]] ^ same_way;
          if (turn[across / 3] < 0) {
            turn[across / 3] = wanted;
            members.push_back(across / 3);
          } else if (turn[across / 3] != wanted) {
            component.is_orientable = false;
          }
        }
      }
      component.num_faces = static_cast<int>(members.size());
      if (component.is_orientable) Orient(members, turn, boundary_of, &component, result);
      result->components.push_back(component);
    }
    std::sort(result->turned_faces.begin(), result->turned_faces.end());
    std::stable_sort(result->components.begin(), result->components.end(),
                     [](const MeshComponent& a, const MeshComponent& b) { return a.num_faces > b.num_faces; });
  }

  /// Determines the outward orientation and lists the faces that are turned against it.
  void Orient(const std::vector<int>& members, const std::vector<int>& turn, const std::vector<int>& boundary_of,
              MeshComponent* component, CheckMeshResult* result) const {
    const Eigen::RowVector3d origin = vertices_.row(faces_(members[0], 0));  // nearby, for precision
    double volume = 0, area = 0;
    int against = 0;
    for (const int f : members) {
      const double sign = turn[f] == 0 ? 1 : -1;
      const Eigen::RowVector3d a = vertices_.row(faces_(f, 0)) - origin, b = vertices_.row(faces_(f, 1)) - origin,
                               c = vertices_.row(faces_(f, 2)) - origin;
      volume += sign * a.dot(b.cross(c)) / 6;
      area += 0.5 * (b - a).cross(c - a).norm();
      against += turn[f];
      for (int h = 3 * f; h < 3 * f + 3; ++h) {
        if (boundary_of[h] < 0) continue;
        const Eigen::RowVector3d mean = loop_means_.row(loop_of_edge_[boundary_of[h]]) - origin,
                                 from = vertices_.row(From(h)) - origin, to = vertices_.row(To(h)) - origin;
        volume += sign * to.dot(from.cross(mean)) / 6;
      }
    }
    const bool has_outside = std::abs(volume) >= kNoOutside * std::pow(area, 1.5) && area > 0;
    const int wrong = has_outside ? (volume > 0 ? 1 : 0) : 2 * against > static_cast<int>(members.size()) ? 0 : 1;
    component->volume_m3 = has_outside ? std::abs(volume) : 0;
    for (const int f : members) {
      if (turn[f] != wrong) continue;
      ++component->turned_faces;
      result->turned_faces.push_back(number_of_face_[f]);
    }
  }

  const MatrixX3d& vertices_;
  const MatrixX3i& faces_;
  const std::vector<int> number_of_face_;  // in the whole mesh
  const MeshAdjacency mesh_;
  std::vector<int> boundary_;              // half-edges
  std::vector<std::vector<int>> crowded_;  // half-edges of each edge of more than two faces
  std::vector<int> loop_of_edge_;          // of boundary_
  MatrixX3d loop_means_;
};

}  // namespace

bool CheckMeshResult::IsClean() const {
  return repeated_corner_faces.empty() && flat_faces.empty() && duplicate_faces.empty() &&
         unreferenced_vertices.empty() && duplicate_vertices.empty() && non_manifold_edges.empty() &&
         non_manifold_vertices.empty() && boundary_edges == 0 && inconsistent_edges == 0 && turned_faces.empty() &&
         components.size() == 1 && components[0].is_orientable;
}

std::vector<int> SuperfluousFaces(const CheckMeshResult& result) {
  std::vector<int> faces = result.repeated_corner_faces;
  faces.insert(faces.end(), result.duplicate_faces.begin(), result.duplicate_faces.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

CheckMeshResult CheckMesh(const MatrixX3d& vertices, const MatrixX3i& faces, const CheckMeshOptions& options) {
  const int V = static_cast<int>(vertices.rows());
  BODYLOOM_CHECK(vertices.allFinite(), "CheckMesh: a vertex is not finite");
  BODYLOOM_CHECK(std::isfinite(options.same_place_m) && options.same_place_m >= 0, "CheckMesh: same_place_m is ",
                 options.same_place_m, ", expected 0 or more");
  BODYLOOM_CHECK(std::isfinite(options.flat_height_m) && options.flat_height_m >= 0, "CheckMesh: flat_height_m is ",
                 options.flat_height_m, ", expected 0 or more");
  std::vector<bool> referenced(V, false);
  for (Eigen::Index i = 0; i < faces.size(); ++i) {
    const int v = faces.data()[i];
    BODYLOOM_CHECK(v >= 0 && v < V, "CheckMesh: face ", i / 3, " names vertex ", v, ", expected 0..", V - 1);
    referenced[v] = true;
  }
  CheckMeshResult result;
  for (int v = 0; v < V; ++v) {
    if (!referenced[v]) result.unreferenced_vertices.push_back(v);
  }
  FindSuperfluousFaces(vertices, faces, options.flat_height_m, &result);
  FindDuplicateVertices(vertices, options.same_place_m, &result);
  const std::vector<int> superfluous = SuperfluousFaces(result);
  std::vector<int> kept;
  for (int f = 0; f < faces.rows(); ++f) {
    if (!std::binary_search(superfluous.begin(), superfluous.end(), f)) kept.push_back(f);
  }
  MatrixX3i kept_faces(static_cast<Eigen::Index>(kept.size()), 3);
  for (size_t i = 0; i < kept.size(); ++i) kept_faces.row(static_cast<Eigen::Index>(i)) = faces.row(kept[i]);
  Topology(vertices, kept_faces, kept).Run(&result);
  return result;
}

}  // namespace bodyloom
