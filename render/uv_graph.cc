// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/uv_graph.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bodyloom/render/uv_sample.h"

namespace bodyloom {
namespace {

/// The node nearest to a place on the atlas, at most a texel away; −1: none.
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
