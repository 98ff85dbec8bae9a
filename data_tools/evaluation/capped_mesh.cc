// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/capped_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace bodyloom {

double SquaredDistanceToTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const auto outside = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return normal.dot((to - from).cross(p - from)) < 0;
  };
  const double square = normal.squaredNorm();
  if (square > 0 && !outside(a, b) && !outside(b, c) && !outside(c, a)) {
    const double height = normal.dot(p - a);
    return height * height / square;
  }
  const auto to_segment = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d along = to - from;
    const double length = along.squaredNorm();
    const double share = length > 0 ? std::clamp(along.dot(p - from) / length, 0.0, 1.0) : 0.0;
    return (p - from - share * along).squaredNorm();
  };
  return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

const Eigen::Matrix3d& GenericRotation() {
  static const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.7391, Eigen::Vector3d(0.3178, 0.8021, -0.5062).normalized()).toRotationMatrix();
  return rotation;
}

CappedMesh::CappedMesh(const MatrixX3i& mesh_faces, const std::vector<int>& faces) {
  std::map<int, int> point_of_vertex;
  std::map<std::pair<int, int>, int> surplus;  // half-edges minus those the other way
  for (const int f : faces) {
    Face face{};
    for (int c = 0; c < 3; ++c) {
      const auto [entry, is_new] = point_of_vertex.try_emplace(mesh_faces(f, c), static_cast<int>(vertex_.size()));
      if (is_new) vertex_.push_back(mesh_faces(f, c));
      face.corner[c] = entry->second;
    }
    if (face.corner[0] == face.corner[1] || face.corner[1] == face.corner[2] || face.corner[2] == face.corner[0]) {
      continue;
    }
    faces_.push_back(face);
    for (int c = 0; c < 3; ++c) {
      const int from = face.corner[c], to = face.corner[(c + 1) % 3];
      surplus[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  num_skin_ = faces_.size();
  // Boundary edges that touch, directly or through others, are one loop.
  std::vector<int> root(vertex_.size(), -1);
  const auto find = [&](int i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& [edge, count] : surplus) {
    if (count == 0) continue;
    for (const int i : {edge.first, edge.second}) root[i] = root[i] < 0 ? i : root[i];
    root[find(edge.second)] = find(edge.first);
  }
  std::map<int, int> loop_of_root;
  for (int i = 0; i < static_cast<int>(root.size()); ++i) {
    if (root[i] < 0) continue;
    const auto [entry, is_new] = loop_of_root.try_emplace(find(i), static_cast<int>(loops_.size()));
    if (is_new) loops_.emplace_back();
    loops_[entry->second].push_back(i);
  }
  for (const auto& [edge, count] : surplus) {
    for (int i = 0; i < std::abs(count); ++i) {  // the other way round than the faces
      const int from = count > 0 ? edge.second : edge.first, to = count > 0 ? edge.first : edge.second;
      faces_.push_back({{from, to, static_cast<int>(vertex_.size()) + loop_of_root.at(find(from))}});
    }
  }
}

void CappedMesh::Place(const MatrixX3d& turned_vertices) {
  points_.resize(vertex_.size());
  for (size_t i = 0; i < vertex_.size(); ++i) points_[i] = turned_vertices.row(vertex_[i]).transpose();
  for (const std::vector<int>& loop : loops_) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int i : loop) sum += points_[i];
    points_.push_back(sum / static_cast<double>(loop.size()));
  }
  low_.setConstant(std::numeric_limits<double>::infinity());
  high_ = -low_;
  for (const Eigen::Vector3d& point : points_) low_ = low_.cwiseMin(point), high_ = high_.cwiseMax(point);
  has_grid_ = has_centres_ = false;
}

int CappedMesh::CellOf(double value, int axis) const {
  const double share = (value - low_[axis]) / std::max(high_[axis] - low_[axis], 1e-12);
  return std::clamp(static_cast<int>(share * cells_), 0, cells_ - 1);
}

void CappedMesh::SortIntoGrid() {
  cells_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(faces_.size()) / 2)), 1, 256);
  struct Range {
    int x_begin, x_end, y_begin, y_end;
  };
  std::vector<Range> ranges;
  ranges.reserve(faces_.size());
  cell_begin_.assign(static_cast<size_t>(cells_) * cells_ + 1, 0);
  for (const Face& face : faces_) {
    const Eigen::Vector3d &a = points_[face.corner[0]], &b = points_[face.corner[1]], &c = points_[face.corner[2]];
    const Eigen::Vector3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    ranges.push_back({CellOf(low.x(), 0), CellOf(high.x(), 0) + 1, CellOf(low.y(), 1), CellOf(high.y(), 1) + 1});
    const Range& r = ranges.back();
    for (int y = r.y_begin; y < r.y_end; ++y) {
      for (int x = r.x_begin; x < r.x_end; ++x) ++cell_begin_[static_cast<size_t>(y) * cells_ + x + 1];
    }
  }
  for (size_t i = 1; i < cell_begin_.size(); ++i) cell_begin_[i] += cell_begin_[i - 1];
  cell_face_.resize(cell_begin_.back());
  std::vector<int> next(cell_begin_.begin(), cell_begin_.end() - 1);
  for (size_t f = 0; f < faces_.size(); ++f) {
    const Range& r = ranges[f];
    for (int y = r.y_begin; y < r.y_end; ++y) {
      for (int x = r.x_begin; x < r.x_end; ++x) {
        cell_face_[next[static_cast<size_t>(y) * cells_ + x]++] = static_cast<int>(f);
      }
    }
  }
  has_grid_ = true;
}

int CappedMesh::Crossing(const Face& face, const Eigen::Vector3d& p) const {
  // Side of the projected edge on which the point lies, computed from the lower vertex number to the higher, so that
  // both faces of the edge get the same value.
  int left = 0;
  for (int c = 0; c < 3; ++c) {
    const int from = face.corner[c], to = face.corner[c == 2 ? 0 : c + 1];
    const Eigen::Vector3d &a = points_[std::min(from, to)], &b = points_[std::max(from, to)];
    const bool is_left = (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x()) >= 0;
    left += is_left == (from < to) ? 1 : -1;
  }
  if (left != 3 && left != -3) return 0;
  const Eigen::Vector3d& a = points_[face.corner[0]];
  const Eigen::Vector3d normal = (points_[face.corner[1]] - a).cross(points_[face.corner[2]] - a);
  // The plane at p's x and y is above p: n·(p − a) and n_z have opposite signs.
  const double side = normal.dot(p - a);
  if (left == 3) return side < 0 ? 1 : 0;  // faces up: the ray leaves
  return side > 0 ? -1 : 0;
}

bool CappedMesh::Contains(const Eigen::Vector3d& p) {
  if (faces_.empty() || (p.array() < low_.array()).any() || (p.array() > high_.array()).any()) return false;
  if (!has_grid_) SortIntoGrid();
  const size_t cell = static_cast<size_t>(CellOf(p.y(), 1)) * cells_ + CellOf(p.x(), 0);
  int winding = 0;
  for (int i = cell_begin_[cell]; i < cell_begin_[cell + 1]; ++i) winding += Crossing(faces_[cell_face_[i]], p);
  return winding != 0;
}

void CappedMesh::FindCentres() {
  centre_x_.resize(num_skin_), centre_y_.resize(num_skin_), centre_z_.resize(num_skin_);
  double largest = 0;
  for (size_t f = 0; f < num_skin_; ++f) {
    const int* corner = faces_[f].corner;
    const Eigen::Vector3d centre = (points_[corner[0]] + points_[corner[1]] + points_[corner[2]]) / 3 - low_;
    for (int c = 0; c < 3; ++c) largest = std::max(largest, (points_[corner[c]] - low_ - centre).squaredNorm());
    centre_x_[f] = static_cast<float>(centre.x());
    centre_y_[f] = static_cast<float>(centre.y());
    centre_z_[f] = static_cast<float>(centre.z());
  }
  largest_radius_ = std::sqrt(largest);
  has_centres_ = true;
}

double CappedMesh::Distance(const Eigen::Vector3d& p) {
  if (num_skin_ == 0) return std::numeric_limits<double>::infinity();
  if (!has_centres_) FindCentres();
  const Eigen::Vector3f q = (p - low_).cast<float>();
  const auto square = [&](size_t f) {
    const float x = centre_x_[f] - q.x(), y = centre_y_[f] - q.y(), z = centre_z_[f] - q.z();
    return x * x + y * y + z * z;
  };
  float nearest = std::numeric_limits<float>::infinity();
  for (size_t f = 0; f < num_skin_; ++f) nearest = std::min(nearest, square(f));
  const double reach = (std::sqrt(double{nearest}) + largest_radius_) * (1 + 1e-5) + 1e-6;  // floats' rounding
  const auto limit = static_cast<float>(reach * reach);
  double best = std::numeric_limits<double>::infinity();
  for (size_t f = 0; f < num_skin_; ++f) {
    if (square(f) > limit) continue;
    const int* corner = faces_[f].corner;
    best = std::min(best, SquaredDistanceToTriangle(p, points_[corner[0]], points_[corner[1]], points_[corner[2]]));
  }
  return std::sqrt(best);
}

}  // namespace bodyloom
