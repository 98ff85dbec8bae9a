// SPDX-License-Identifier: Apache-2.0
#include "apps/cgal/surface_tools.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace bodyloom {
namespace {

constexpr double kSheetShare = 0.75;  // of a component's area that closing a loop may add; a hemisphere takes 0.5

using CgalPoint = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using CgalMesh = CGAL::Surface_mesh<CgalPoint>;

/// A mesh as CGAL takes it: points and polygons in the order of vertices and faces.
struct PolygonSoup {
  PolygonSoup(const MatrixX3d& vertices, const MatrixX3i& faces) {
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      points.emplace_back(vertices(v, 0), vertices(v, 1), vertices(v, 2));
    }
    for (Eigen::Index f = 0; f < faces.rows(); ++f) {
      polygons.push_back({size_t(faces(f, 0)), size_t(faces(f, 1)), size_t(faces(f, 2))});
    }
  }

  std::vector<CgalPoint> points;
  std::vector<std::array<size_t, 3>> polygons;
};

/// Returns true if the loop is short enough and no two of its vertices coincide.
bool CanBeClosed(const CgalMesh& mesh, CgalMesh::Halfedge_index border, int max_edges) {
  std::set<CgalPoint> places;
  int edges = 0;
  for (const auto half_edge : CGAL::halfedges_around_face(border, mesh)) {
    places.insert(mesh.point(mesh.target(half_edge)));
    ++edges;
  }
  return edges <= max_edges && static_cast<int>(places.size()) == edges;
}

}  // namespace

std::vector<std::array<int, 2>> CrossingFaces(const MatrixX3d& vertices, const MatrixX3i& faces) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  auto [points, polygons] = PolygonSoup(vertices, faces);
  // Also what no half-edge structure holds becomes one; the order of the faces stays.
  if (!pmp::is_polygon_soup_a_polygon_mesh(polygons)) pmp::orient_polygon_soup(points, polygons);
  CgalMesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> found;
  pmp::self_intersections(mesh, std::back_inserter(found));
  std::vector<std::array<int, 2>> pairs;
  for (const auto& [a, b] : found) {
    const auto i = static_cast<int>(a.idx()), j = static_cast<int>(b.idx());
    pairs.push_back({std::min(i, j), std::max(i, j)});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

MatrixX3i HoleFaces(const MatrixX3d& vertices, const MatrixX3i& faces, int max_edges) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  const PolygonSoup soup(vertices, faces);
  MatrixX3i added(0, 3);
  if (!pmp::is_polygon_soup_a_polygon_mesh(soup.polygons)) return added;
  CgalMesh mesh;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, mesh);
  std::vector<CgalMesh::Halfedge_index> borders;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(borders));
  std::vector<CgalMesh::Face_index> kept;
  for (const auto border : borders) {
    if (!CanBeClosed(mesh, border, max_edges)) continue;
    std::vector<CgalMesh::Face_index> component, patch;
    pmp::connected_component(mesh.face(mesh.opposite(border)), mesh, std::back_inserter(component));
    pmp::triangulate_hole(mesh, border, std::back_inserter(patch));
    if (pmp::area(patch, mesh) <= kSheetShare * pmp::area(component, mesh)) {
      kept.insert(kept.end(), patch.begin(), patch.end());
    }
  }
  added.resize(static_cast<Eigen::Index>(kept.size()), 3);
  for (size_t f = 0; f < kept.size(); ++f) {
    int k = 0;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(kept[f]))) {
      added(static_cast<Eigen::Index>(f), k++) = static_cast<int>(vertex.idx());
    }
  }
  return added;
}

}  // namespace bodyloom
