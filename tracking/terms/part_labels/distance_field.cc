// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/part_labels/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "geometry/base/check.h"
#include "geometry/base/equal_bytes.h"

namespace bodyloom {
namespace {

constexpr float kFar = 1e9F;  // squares stay finite in double

/// min over k of (y − k)² + g[k]² at y = 0, step, 2·step, …; g is non-negative.
class LowerEnvelope {
 public:
  void Find(const std::vector<float>& g, int step, std::vector<double>* squared) {
    const int n = static_cast<int>(g.size());
    vertex_.resize(n);
    from_.resize(n + 1);
    int last = -1;
    for (int q = 0; q < n; ++q) {
      if (g[q] >= kFar) continue;
      double start = -std::numeric_limits<double>::infinity();
      while (last >= 0) {
        const int v = vertex_[last];
        start = (Height(g, q) - Height(g, v)) / (2.0 * (q - v));
        if (start > from_[last]) break;
        --last;
      }
      if (last < 0) start = -std::numeric_limits<double>::infinity();
      vertex_[++last] = q;
      from_[last] = start;
    }
    for (size_t i = 0, k = 0; i < squared->size(); ++i) {
      if (last < 0) {
        (*squared)[i] = static_cast<double>(kFar) * kFar;
        continue;
      }
      const double y = static_cast<double>(i) * step;
      while (static_cast<int>(k) < last && from_[k + 1] < y) ++k;
      const double dy = y - vertex_[k];
      (*squared)[i] = dy * dy + static_cast<double>(g[vertex_[k]]) * g[vertex_[k]];
    }
  }

 private:
  static double Height(const std::vector<float>& g, int q) {
    return static_cast<double>(g[q]) * g[q] + static_cast<double>(q) * q;
  }
  std::vector<int> vertex_;
  std::vector<double> from_;
};

/// A row of pixels as runs of one kind.
class RowOfRuns {
 public:
  using Pixel = DistanceField::Pixel;

  void Find(const std::vector<Pixel>& row) {
    runs_.clear();
    width_ = static_cast<int>(row.size());
    const auto* bytes = reinterpret_cast<const uint8_t*>(row.data());
    for (int begin = 0; begin < width_; begin = runs_.back().end) {
      runs_.push_back({begin, EndOfRun(bytes, begin, width_), row[begin]});
    }
  }

  /// found(c, pixel) for each node, at pixel c · cell_px, with the last pixel of the kind that is not behind it.
  template <typename Found>
  void EachLastAtOrBefore(Pixel wanted, int columns, int cell_px, const Found& found) const {
    size_t r = 0;
    int last = -1;
    for (int c = 0; c < columns; ++c) {
      const int at = std::min(c * cell_px, width_ - 1);
      for (; runs_[r].end <= at; ++r) last = runs_[r].kind == wanted ? runs_[r].end - 1 : last;
      const int pixel = runs_[r].kind == wanted ? at : last;
      if (pixel >= 0) found(c, pixel);
    }
  }

  /// The same with the first pixel of the kind that is not before the node.
  template <typename Found>
  void EachFirstAtOrAfter(Pixel wanted, int columns, int cell_px, const Found& found) const {
    size_t r = runs_.size() - 1;
    int first = -1;
    for (int c = std::min(columns - 1, (width_ - 1) / cell_px); c >= 0; --c) {
      const int at = c * cell_px;
      for (; runs_[r].begin > at; --r) first = runs_[r].kind == wanted ? runs_[r].begin : first;
      const int pixel = runs_[r].kind == wanted ? at : first;
      if (pixel >= 0) found(c, pixel);
    }
  }

 private:
  struct Run {
    int begin, end;
    Pixel kind;
  };
  std::vector<Run> runs_;
  int width_ = 0;
};

/// Catmull–Rom weights of nodes −1, 0, 1, 2 at s in [0, 1], and their derivatives.
void CubicWeights(double s, std::array<double, 4>* w, std::array<double, 4>* d) {
  const double s2 = s * s, s3 = s2 * s;
  *w = {0.5 * (-s3 + 2 * s2 - s), 0.5 * (3 * s3 - 5 * s2 + 2), 0.5 * (-3 * s3 + 4 * s2 + s), 0.5 * (s3 - s2)};
  *d = {0.5 * (-3 * s2 + 4 * s - 1), 0.5 * (9 * s2 - 10 * s), 0.5 * (-9 * s2 + 8 * s + 1), 0.5 * (3 * s2 - 2 * s)};
}

}  // namespace

DistanceField::DistanceField(int x_begin, int y_begin, int width, int height, int cell_px,
                             const std::function<void(int y, Pixel* row)>& fill_row)
    : x_begin_(x_begin), y_begin_(y_begin), cell_px_(cell_px) {
  BODYLOOM_CHECK(width > 0 && height > 0 && cell_px > 0, "distance field: ", width, "x", height, " pixels in cells of ",
                 cell_px, ", expected positive sizes");
  columns_ = std::max(2, (width + cell_px - 2) / cell_px + 1);
  rows_ = std::max(2, (height + cell_px - 2) / cell_px + 1);
  // Along rows: distance from every node's column to the nearest pixel inside, and outside, of the same row.
  std::array<std::vector<std::vector<float>>, 2> along;  // by kind, by node column: one value a pixel row
  for (auto& kind : along) kind.assign(columns_, std::vector<float>(height, kFar));
  std::vector<Pixel> row(width);
  std::vector<Pixel> at_node(static_cast<size_t>(columns_) * rows_, Pixel::kUnknown);
  const auto add = [&](int kind, int c, int y, int pixel) {
    float& distance = along[kind][c][y];
    distance = std::min(distance, static_cast<float>(std::abs(c * cell_px - pixel)));
  };
  RowOfRuns runs;
  for (int y = 0; y < height; ++y) {
    fill_row(y_begin + y, row.data());
    runs.Find(row);
    for (int kind = 0; kind < 2; ++kind) {
      const Pixel wanted = kind == 0 ? Pixel::kInside : Pixel::kOutside;
      runs.EachLastAtOrBefore(wanted, columns_, cell_px, [&](int c, int pixel) { add(kind, c, y, pixel); });
      runs.EachFirstAtOrAfter(wanted, columns_, cell_px, [&](int c, int pixel) { add(kind, c, y, pixel); });
    }
    if (y % cell_px != 0) continue;
    for (int c = 0; c < columns_ && c * cell_px < width; ++c) {
      at_node[static_cast<size_t>(y / cell_px) * columns_ + c] = row[c * cell_px];
    }
  }
  // Across rows, at the nodes.
  const double diagonal = std::hypot(width, height);
  nodes_.resize(static_cast<size_t>(columns_) * rows_);
  LowerEnvelope envelope;
  std::vector<double> to_inside(rows_), to_outside(rows_);
  for (int c = 0; c < columns_; ++c) {
    envelope.Find(along[0][c], cell_px, &to_inside);
    envelope.Find(along[1][c], cell_px, &to_outside);
    for (int r = 0; r < rows_; ++r) {
      const double in = std::min(std::sqrt(to_inside[r]), diagonal), out = std::min(std::sqrt(to_outside[r]), diagonal);
      const Pixel here = at_node[static_cast<size_t>(r) * columns_ + c];
      const double distance = here == Pixel::kInside ? 0.5 - out : here == Pixel::kOutside ? in - 0.5 : in - out;
      nodes_[static_cast<size_t>(r) * columns_ + c] = static_cast<float>(distance);
    }
  }
}

float DistanceField::Node(int column, int row) const {
  return nodes_[static_cast<size_t>(std::clamp(row, 0, rows_ - 1)) * columns_ + std::clamp(column, 0, columns_ - 1)];
}

double DistanceField::Evaluate(const Eigen::Vector2d& pixel, Eigen::RowVector2d* gradient) const {
  const Eigen::Vector2d limit(double{1} * (columns_ - 1) * cell_px_, double{1} * (rows_ - 1) * cell_px_);
  const Eigen::Vector2d local = pixel - Eigen::Vector2d(x_begin_, y_begin_);
  const Eigen::Vector2d inside = local.cwiseMax(0).cwiseMin(limit);
  const int column = std::min(static_cast<int>(inside.x() / cell_px_), columns_ - 2);
  const int row = std::min(static_cast<int>(inside.y() / cell_px_), rows_ - 2);
  std::array<double, 4> wx, dx, wy, dy;
  CubicWeights(inside.x() / cell_px_ - column, &wx, &dx);
  CubicWeights(inside.y() / cell_px_ - row, &wy, &dy);
  double value = 0;
  Eigen::RowVector2d slope = Eigen::RowVector2d::Zero();
  for (int r = 0; r < 4; ++r) {
    double along = 0, d_along = 0;
    for (int c = 0; c < 4; ++c) {
      const double node = Node(column + c - 1, row + r - 1);
      along += wx[c] * node;
      d_along += dx[c] * node;
    }
    value += wy[r] * along;
    slope += Eigen::RowVector2d(wy[r] * d_along, dy[r] * along) / cell_px_;
  }
  const Eigen::Vector2d beyond = local - inside;
  const double distance = beyond.norm();
  if (gradient != nullptr) {
    for (int axis = 0; axis < 2; ++axis) {
      if (beyond[axis] != 0) slope[axis] = beyond[axis] / distance;
    }
    *gradient = slope;
  }
  return value + distance;
}

}  // namespace bodyloom
