// SPDX-License-Identifier: Apache-2.0
#include "apps/cgal/crossing_faces.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace bodyloom {

std::vector<std::array<int, 2>> CrossingFaces(const MatrixX3d& vertices, const MatrixX3i& faces) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  using Mesh = CGAL::Surface_mesh<Point>;
  std::vector<Point> points;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    points.emplace_back(vertices(v, 0), vertices(v, 1), vertices(v, 2));
  }
  std::vector<std::array<size_t, 3>> polygons;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    polygons.push_back({size_t(faces(f, 0)), size_t(faces(f, 1)), size_t(faces(f, 2))});
  }
  // Also what no half-edge structure holds becomes one; the order of the faces stays.
  if (!pmp::is_polygon_soup_a_polygon_mesh(polygons)) pmp::orient_polygon_soup(points, polygons);
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
  pmp::self_intersections(mesh, std::back_inserter(found));
  std::vector<std::array<int, 2>> pairs;
  for (const auto& [a, b] : found) {
    const auto i = static_cast<int>(a.idx()), j = static_cast<int>(b.idx());
    pairs.push_back({std::min(i, j), std::max(i, j)});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace bodyloom
