// SPDX-License-Identifier: Apache-2.0
#include "render/texture/chart_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Computes the barycentrics of the point of a triangle nearest to x; returns its squared distance.
double NearestInTriangle(const std::array<Vector2d, 3>& t, const Vector2d& x, Vector3d* barycentric) {
  const double area = Cross(t[1] - t[0], t[2] - t[0]);
  if (area != 0) {
    const Vector3d b(Cross(t[1] - x, t[2] - x) / area, Cross(t[2] - x, t[0] - x) / area,
                     Cross(t[0] - x, t[1] - x) / area);
    if (b.minCoeff() >= 0) {
      *barycentric = b;
      return 0;
    }
  }
  double best = std::numeric_limits<double>::infinity();
  for (int c = 0; c < 3; ++c) {
    const Vector2d edge = t[(c + 1) % 3] - t[c];
    const double length2 = edge.squaredNorm();
    const double along = length2 > 0 ? std::clamp(edge.dot(x - t[c]) / length2, 0.0, 1.0) : 0.0;
    const double distance2 = (t[c] + along * edge - x).squaredNorm();
    if (distance2 < best) {
      best = distance2;
      barycentric->setZero();
      (*barycentric)[c] = 1 - along;
      (*barycentric)[(c + 1) % 3] = along;
    }
  }
  return best;
}

int CellOf(double value, double low, double cell, int cells) {
  return std::clamp(static_cast<int>(std::floor((value - low) / cell)), 0, cells - 1);
}

}  // namespace

ChartLookup::ChartLookup(const BodyModel& body) {
  const BodyModelData& d = body.data();
  BODYLOOM_CHECK(body.has_parts() && d.face_iuv.rows() > 0, "the body '", body.name(), "' has no chart coordinates");
  for (int f = 0; f < body.num_faces(); ++f) {
    const int part = d.face_part[f];
    if (part < 1 || part > 24) continue;
    Triangle triangle{f, {}};
    for (int c = 0; c < 3; ++c) triangle.corners[c] = d.face_iuv.block<1, 2>(f, 2 * c).transpose().cast<double>();
    charts_[part].triangles.push_back(triangle);
  }
  for (Chart& chart : charts_) {
    if (chart.triangles.empty()) continue;
    Vector2d low = chart.triangles[0].corners[0], high = low;
    for (const Triangle& triangle : chart.triangles) {
      for (const Vector2d& corner : triangle.corners) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
    }
    chart.low = low;
    chart.cell = ((high - low) / kCells).cwiseMax(1e-9);
    std::vector<std::vector<int>> cells(size_t{kCells} * kCells);
    for (size_t i = 0; i < chart.triangles.size(); ++i) {
      const auto& t = chart.triangles[i].corners;
      const Vector2d from = t[0].cwiseMin(t[1]).cwiseMin(t[2]), to = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
      for (int y = CellOf(from.y(), low.y(), chart.cell.y(), kCells);
           y <= CellOf(to.y(), low.y(), chart.cell.y(), kCells); ++y) {
        for (int x = CellOf(from.x(), low.x(), chart.cell.x(), kCells);
             x <= CellOf(to.x(), low.x(), chart.cell.x(), kCells); ++x) {
          cells[size_t(y) * kCells + x].push_back(static_cast<int>(i));
        }
      }
    }
    chart.begin.push_back(0);
    for (const auto& cell : cells) {
      chart.entries.insert(chart.entries.end(), cell.begin(), cell.end());
      chart.begin.push_back(static_cast<int>(chart.entries.size()));
    }
  }
}

SurfacePoint ChartLookup::Find(int part, const Vector2d& uv, double* gap) const {
  SurfacePoint found;
  found.face = -1;
  if (gap != nullptr) *gap = std::numeric_limits<double>::infinity();
  if (part < 1 || part > 24 || charts_[part].triangles.empty() || !uv.allFinite()) return found;
  const Chart& chart = charts_[part];
  const int x_0 = CellOf(uv.x(), chart.low.x(), chart.cell.x(), kCells);
  const int y_0 = CellOf(uv.y(), chart.low.y(), chart.cell.y(), kCells);
  // Rings of cells around the one nearest to uv. A cell of ring k lies at least k − 1 cells away from uv (uv itself may
  // lie outside the grid, which only adds to that).
  double best = std::numeric_limits<double>::infinity();
  const double smallest_cell = chart.cell.minCoeff();
  for (int ring = 0; ring < kCells; ++ring) {
    const double minimum = std::max(0, ring - 1) * smallest_cell;
    if (minimum * minimum > best) break;
    for (int y = std::max(0, y_0 - ring); y <= std::min(kCells - 1, y_0 + ring); ++y) {
      const bool whole_row = std::abs(y - y_0) == ring;
      for (int x = x_0 - ring; x <= x_0 + ring; x += whole_row || ring == 0 ? 1 : 2 * ring) {
        if (x < 0 || x >= kCells) continue;
        for (int k = chart.begin[size_t(y) * kCells + x]; k < chart.begin[size_t(y) * kCells + x + 1]; ++k) {
          const Triangle& triangle = chart.triangles[chart.entries[k]];
          Vector3d barycentric;
          const double distance2 = NearestInTriangle(triangle.corners, uv, &barycentric);
          if (distance2 < best || (distance2 == best && triangle.face < found.face)) {
            best = distance2;
            found = {triangle.face, barycentric};
          }
        }
      }
    }
    if (best == 0) break;
  }
  if (gap != nullptr) *gap = std::sqrt(best);
  return found;
}

}  // namespace bodyloom
