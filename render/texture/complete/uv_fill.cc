// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/uv_fill.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/base/check.h"
#include "render/texture/uv_sample.h"

namespace bodyloom {
namespace {

constexpr int kMaxLevels = 14;
constexpr int kTip = 8;     ///< texels
constexpr int kSweeps = 4;  ///< averages with neighbours per level

void CheckMaps(size_t pixels, int num_channels, size_t values) {
  BODYLOOM_CHECK(num_channels > 0 && values == pixels * num_channels, "filling: maps of ", values, " values, expected ",
                 num_channels, " x ", pixels);
}

}  // namespace

namespace uv_fill_internal {

/// Taps of each gutter texel at the surface point it shows; those of whole charts only.
struct GutterTaps {
  std::vector<std::pair<int, UvTaps>> taps;
  GutterTaps(const BodyModel& body, const UvTexelTable& table) {
    const UvCharts charts = FindUvCharts(body);
    std::vector<char> inside(size_t(table.width) * table.height, 0);
    for (size_t i = 0; i < table.size(); ++i) inside[table.pixel[i]] = !table.in_gutter[i];
    for (size_t i = 0; i < table.size(); ++i) {
      if (!table.in_gutter[i]) continue;
      UvTaps all = TapsAt(table, UvPointAt(body, charts, table.face[i], table.barycentric[i].cast<double>()));
      UvTaps own;  // only texels that are not in the gutter
      double sum = 0;
      for (int k = 0; k < all.count; ++k) {
        if (!inside[all.pixel[k]] || all.weight[k] <= 1e-6) continue;
        own.pixel[own.count] = all.pixel[k];
        own.weight[own.count++] = all.weight[k];
        sum += all.weight[k];
      }
      for (int k = 0; k < own.count; ++k) own.weight[k] /= sum;
      if (own.count == 0) own = Nearest(table, inside, table.pixel[i]);
      if (own.count > 0) taps.emplace_back(table.pixel[i], own);
    }
  }
  /// For tips of charts without a texel centre near the point: the nearest texel of the chart in the map.
  static UvTaps Nearest(const UvTexelTable& table, const std::vector<char>& inside, int pixel) {
    UvTaps taps;
    const int x = pixel % table.width, y = pixel / table.width;
    int nearest = 1 << 30;
    for (int row = std::max(0, y - kTip); row <= std::min(table.height - 1, y + kTip); ++row) {
      for (int column = std::max(0, x - kTip); column <= std::min(table.width - 1, x + kTip); ++column) {
        const int at = row * table.width + column, distance = (row - y) * (row - y) + (column - x) * (column - x);
        if (!inside[at] || table.chart_at[at] != table.chart_at[pixel] || distance >= nearest) continue;
        nearest = distance;
        taps.count = 1;
        taps.pixel[0] = at;
        taps.weight[0] = 1;
      }
    }
    return taps;
  }
  /// known: empty, or one byte per texel.
  void Fill(size_t pixels, int num_channels, std::span<float> maps, std::span<const uint8_t> known = {}) const {
    for (const auto& [pixel, own] : taps) {
      double total = 0;
      for (int k = 0; k < own.count; ++k) total += known.empty() || known[own.pixel[k]] ? own.weight[k] : 0;
      if (!(total > 0)) continue;
      for (int c = 0; c < num_channels; ++c) {
        float* map = maps.data() + pixels * c;
        double value = 0;
        for (int k = 0; k < own.count; ++k) {
          if (known.empty() || known[own.pixel[k]]) value += own.weight[k] * map[own.pixel[k]];
        }
        map[pixel] = static_cast<float>(value / total);
      }
    }
  }
};

}  // namespace uv_fill_internal

using uv_fill_internal::GutterTaps;

struct PyramidFill::Pyramid {
  struct Level {
    std::vector<int> parent;  ///< parent of each node; empty on the coarsest level
    std::vector<int> begin, neighbour;
    [[nodiscard]] int size() const { return static_cast<int>(begin.size()) - 1; }
  };
  size_t num_pixels;
  std::vector<int> pixel;
  std::vector<Level> levels;
  GutterTaps gutter;

  Pyramid(const BodyModel& body, const UvTexelTable& table)
      : num_pixels(size_t(table.width) * table.height), gutter(body, table) {
    const UvGraph graph = BuildUvGraph(body, table);
    pixel = graph.pixel;
    levels.push_back({{}, graph.begin, graph.neighbour});
    // A cell: its chart and its position on the level's grid.
    std::vector<std::array<int, 3>> cells;
    for (const int p : pixel) cells.push_back({table.chart_at[p], p / table.width, p % table.width});
    while (static_cast<int>(levels.size()) < kMaxLevels && levels.back().size() > 1) {
      std::map<std::array<int, 3>, int> coarse_ids;
      std::vector<std::array<int, 3>> coarse_cells;
      Level& fine = levels.back();
      for (const std::array<int, 3>& cell : cells) {
        const std::array<int, 3> coarse = {cell[0], cell[1] / 2, cell[2] / 2};
        const auto [entry, is_new] = coarse_ids.try_emplace(coarse, static_cast<int>(coarse_cells.size()));
        if (is_new) coarse_cells.push_back(coarse);
        fine.parent.push_back(entry->second);
      }
      std::vector<std::pair<int, int>> edges;
      for (int a = 0; a < fine.size(); ++a) {
        for (int k = fine.begin[a]; k < fine.begin[a + 1]; ++k) {
          const int from = fine.parent[a], to = fine.parent[fine.neighbour[k]];
          if (from != to) edges.emplace_back(from, to);
        }
      }
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
      Level coarse;
      coarse.begin.assign(coarse_cells.size() + 1, 0);
      for (const auto& [from, to] : edges) {
        ++coarse.begin[from + 1];
        coarse.neighbour.push_back(to);
      }
      for (size_t i = 0; i < coarse_cells.size(); ++i) coarse.begin[i + 1] += coarse.begin[i];
      const bool stuck = coarse.size() == fine.size();
      cells.swap(coarse_cells);
      if (stuck) {
        fine.parent.clear();
        break;
      }
      levels.push_back(std::move(coarse));
    }
  }

  /// Averages unknown nodes with their filled neighbours, kSweeps times.
  static void Smooth(const Level& level, const std::vector<float>& weight, std::vector<float>* value) {
    std::vector<float> next = *value;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (int a = 0; a < level.size(); ++a) {
        const int degree = level.begin[a + 1] - level.begin[a];
        if (weight[a] > 0 || degree == 0) continue;
        float sum = 0;
        for (int k = level.begin[a]; k < level.begin[a + 1]; ++k) sum += (*value)[level.neighbour[k]];
        next[a] = sum / static_cast<float>(degree);
      }
      value->swap(next);
    }
  }

  /// On the coarsest level: unknown nodes take their neighbours' mean, outwards; unreachable ones `mean`.
  static void Flood(const Level& level, const std::vector<float>& weight, float mean, std::vector<float>* value) {
    std::vector<char> filled(weight.size());
    for (size_t i = 0; i < weight.size(); ++i) filled[i] = weight[i] > 0;
    for (bool changed = true; changed;) {
      changed = false;
      std::vector<std::pair<int, float>> found;
      for (int a = 0; a < level.size(); ++a) {
        if (filled[a]) continue;
        float sum = 0;
        int count = 0;
        for (int k = level.begin[a]; k < level.begin[a + 1]; ++k) {
          if (!filled[level.neighbour[k]]) continue;
          sum += (*value)[level.neighbour[k]];
          ++count;
        }
        if (count > 0) found.emplace_back(a, sum / static_cast<float>(count));
      }
      for (const auto& [a, x] : found) {
        (*value)[a] = x;
        filled[a] = 1;
        changed = true;
      }
    }
    for (size_t i = 0; i < filled.size(); ++i) {
      if (!filled[i]) (*value)[i] = mean;
    }
  }

  void Fill(std::span<const uint8_t> known, float* map) const {
    std::vector<std::vector<float>> value(levels.size()), weight(levels.size());
    double sum = 0;
    int count = 0;
    for (const int p : pixel) {
      value[0].push_back(known[p] ? map[p] : 0.0F);
      weight[0].push_back(known[p] ? 1.0F : 0.0F);
      sum += value[0].back();
      count += known[p] != 0;
    }
    if (count == 0) return;
    for (size_t l = 0; l + 1 < levels.size(); ++l) {  // pull
      const int n = levels[l + 1].size();
      value[l + 1].assign(n, 0);
      weight[l + 1].assign(n, 0);
      for (int a = 0; a < levels[l].size(); ++a) {
        value[l + 1][levels[l].parent[a]] += weight[l][a] * value[l][a];
        weight[l + 1][levels[l].parent[a]] += weight[l][a];
      }
      for (int a = 0; a < n; ++a) {
        if (weight[l + 1][a] > 0) value[l + 1][a] /= weight[l + 1][a];
        weight[l + 1][a] = std::min(1.0F, weight[l + 1][a]);
      }
    }
    const size_t top = levels.size() - 1;
    Flood(levels[top], weight[top], static_cast<float>(sum / count), &value[top]);
    for (size_t l = top; l-- > 0;) {  // push
      for (int a = 0; a < levels[l].size(); ++a) {
        if (weight[l][a] == 0) value[l][a] = value[l + 1][levels[l].parent[a]];
      }
      Smooth(levels[l], weight[l], &value[l]);
    }
    for (size_t i = 0; i < pixel.size(); ++i) map[pixel[i]] = value[0][i];
  }
};

PyramidFill::PyramidFill(const BodyModel& body, const UvTexelTable& table)
    : pyramid_(std::make_unique<Pyramid>(body, table)) {}
PyramidFill::~PyramidFill() = default;

void PyramidFill::Fill(std::span<const uint8_t> known, int num_channels, std::span<float> maps) const {
  const size_t pixels = pyramid_->num_pixels;
  BODYLOOM_CHECK(known.size() == pixels, "filling: a mask of ", known.size(), " texels, expected ", pixels);
  CheckMaps(pixels, num_channels, maps.size());
  for (int c = 0; c < num_channels; ++c) pyramid_->Fill(known, maps.data() + pixels * c);
  pyramid_->gutter.Fill(pixels, num_channels, maps);
}

struct LaplaceFill::System {
  size_t num_pixels;
  std::vector<int> hole_pixel, mean_pixel;    ///< unknowns; holes not connected to known texels
  std::vector<std::pair<int, int>> boundary;  ///< row, known pixel
  std::vector<int> known_pixel;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
  GutterTaps gutter;

  System(const BodyModel& body, const UvTexelTable& table, std::span<const uint8_t> known)
      : num_pixels(size_t(table.width) * table.height), gutter(body, table) {
    BODYLOOM_CHECK(known.size() == num_pixels, "filling: a mask of ", known.size(), " texels, expected ", num_pixels);
    const UvGraph graph = BuildUvGraph(body, table);
    const int n = graph.num_nodes();
    // Holes connected to known texels.
    std::vector<char> reached(n, 0);
    std::vector<int> front;
    for (int a = 0; a < n; ++a) {
      if (!known[graph.pixel[a]]) continue;
      known_pixel.push_back(graph.pixel[a]);
      reached[a] = 1;
      front.push_back(a);
    }
    while (!front.empty()) {
      const int a = front.back();
      front.pop_back();
      for (int k = graph.begin[a]; k < graph.begin[a + 1]; ++k) {
        if (reached[graph.neighbour[k]]) continue;
        reached[graph.neighbour[k]] = 1;
        front.push_back(graph.neighbour[k]);
      }
    }
    std::vector<int> row(n, -1);
    for (int a = 0; a < n; ++a) {
      if (known[graph.pixel[a]]) continue;
      if (!reached[a]) {
        mean_pixel.push_back(graph.pixel[a]);
        continue;
      }
      row[a] = static_cast<int>(hole_pixel.size());
      hole_pixel.push_back(graph.pixel[a]);
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (int a = 0; a < n; ++a) {
      if (row[a] < 0) continue;
      entries.emplace_back(row[a], row[a], graph.begin[a + 1] - graph.begin[a]);
      for (int k = graph.begin[a]; k < graph.begin[a + 1]; ++k) {
        const int b = graph.neighbour[k];
        if (row[b] >= 0) {
          entries.emplace_back(row[a], row[b], -1);
        } else {
          boundary.emplace_back(row[a], graph.pixel[b]);
        }
      }
    }
    const auto size = static_cast<Eigen::Index>(hole_pixel.size());
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (size > 0) factor.compute(matrix);
  }
};

LaplaceFill::LaplaceFill(const BodyModel& body, const UvTexelTable& table, std::span<const uint8_t> known)
    : system_(std::make_unique<System>(body, table, known)) {}
LaplaceFill::~LaplaceFill() = default;

void LaplaceFill::Fill(int num_channels, std::span<float> maps) const {
  const System& s = *system_;
  CheckMaps(s.num_pixels, num_channels, maps.size());
  if (s.known_pixel.empty()) return;
  const auto size = static_cast<Eigen::Index>(s.hole_pixel.size());
  for (int c = 0; c < num_channels; ++c) {
    float* map = maps.data() + s.num_pixels * c;
    double sum = 0;
    float low = map[s.known_pixel[0]], high = low;
    for (const int p : s.known_pixel) {
      sum += map[p];
      low = std::min(low, map[p]);
      high = std::max(high, map[p]);
    }
    for (const int p : s.mean_pixel) map[p] = static_cast<float>(sum / static_cast<double>(s.known_pixel.size()));
    if (size == 0) continue;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (const auto& [row, pixel] : s.boundary) right[row] += map[pixel];
    const Eigen::VectorXd x = s.factor.solve(right);
    for (Eigen::Index i = 0; i < size; ++i) {
      map[s.hole_pixel[i]] = std::clamp(static_cast<float>(x[i]), low, high);  // rounding
    }
  }
  s.gutter.Fill(s.num_pixels, num_channels, maps);
}

void FillGutter(const BodyModel& body, const UvTexelTable& table, std::span<const uint8_t> known, int num_channels,
                std::span<float> maps) {
  const size_t pixels = size_t(table.width) * table.height;
  BODYLOOM_CHECK(known.size() == pixels, "filling: a mask of ", known.size(), " texels, expected ", pixels);
  CheckMaps(pixels, num_channels, maps.size());
  GutterTaps(body, table).Fill(pixels, num_channels, maps, known);
}

namespace {

/// The node nearest to a point of the atlas, at most a texel away; −1: none.
int NodeNear(const UvTexelTable& table, const std::vector<int>& node_at, const UvPoint& point) {
  const double x = point.uv.x() * table.width - 0.5, y = (1 - point.uv.y()) * table.height - 0.5;
  const int cx = static_cast<int>(std::lround(x)), cy = static_cast<int>(std::lround(y));
  int best = -1;
  double best_distance = 1e9;
  for (int row = cy - 1; row <= cy + 1; ++row) {
    for (int column = cx - 1; column <= cx + 1; ++column) {
      if (row < 0 || column < 0 || row >= table.height || column >= table.width) continue;
      const int pixel = row * table.width + column;
      if (node_at[pixel] < 0 || table.chart_at[pixel] != point.chart) continue;
      const double distance = std::hypot(column - x, row - y);
      if (distance < best_distance) {
        best_distance = distance;
        best = node_at[pixel];
      }
    }
  }
  return best;
}

}  // namespace

UvGraph BuildUvGraph(const BodyModel& body, const UvTexelTable& table) {
  const UvCharts charts = FindUvCharts(body);
  UvGraph graph;
  const size_t pixels = size_t(table.width) * table.height;
  std::vector<int> node_at(pixels, -1), entry_at(pixels, -1);
  for (size_t i = 0; i < table.size(); ++i) {
    entry_at[table.pixel[i]] = static_cast<int>(i);
    if (table.in_gutter[i]) continue;
    node_at[table.pixel[i]] = graph.num_nodes();
    graph.pixel.push_back(table.pixel[i]);
  }
  std::vector<std::pair<int, int>> edges;
  std::vector<std::pair<int, int>> seams;
  for (int node = 0; node < graph.num_nodes(); ++node) {
    const int pixel = graph.pixel[node], x = pixel % table.width, y = pixel / table.width;
    const int steps[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (const auto& step : steps) {
      const int column = x + step[0], row = y + step[1];
      if (column < 0 || row < 0 || column >= table.width || row >= table.height) continue;
      const int beside = row * table.width + column;
      if (table.chart_at[beside] != table.chart_at[pixel]) continue;
      if (node_at[beside] >= 0) {
        edges.emplace_back(std::minmax(node, node_at[beside]));
        continue;
      }
      const int entry = entry_at[beside];
      const int across =
          NodeNear(table, node_at, UvPointAt(body, charts, table.face[entry], table.barycentric[entry].cast<double>()));
      if (across >= 0 && across != node) seams.emplace_back(std::minmax(node, across));
    }
  }
  const auto make_unique = [](std::vector<std::pair<int, int>>* pairs) {
    std::sort(pairs->begin(), pairs->end());
    pairs->erase(std::unique(pairs->begin(), pairs->end()), pairs->end());
  };
  make_unique(&edges);
  make_unique(&seams);
  const size_t inside = edges.size();
  edges.insert(edges.end(), seams.begin(), seams.end());
  make_unique(&edges);
  graph.num_seam_links = static_cast<int>(edges.size() - inside);
  graph.begin.assign(graph.num_nodes() + 1, 0);
  for (const auto& [a, b] : edges) {
    ++graph.begin[a + 1];
    ++graph.begin[b + 1];
  }
  for (int node = 0; node < graph.num_nodes(); ++node) graph.begin[node + 1] += graph.begin[node];
  graph.neighbour.resize(graph.begin.back());
  std::vector<int> next(graph.begin.begin(), graph.begin.end() - 1);
  for (const auto& [a, b] : edges) {
    graph.neighbour[next[a]++] = b;
    graph.neighbour[next[b]++] = a;
  }
  for (int node = 0; node < graph.num_nodes(); ++node) {
    std::sort(graph.neighbour.begin() + graph.begin[node], graph.neighbour.begin() + graph.begin[node + 1]);
  }
  return graph;
}

}  // namespace bodyloom
