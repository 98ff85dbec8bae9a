// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/uv_charts.h"

#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

int RootOf(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

UvCharts FindUvCharts(const BodyModel& body) {
  const BodyModelData& d = body.data();
  BODYLOOM_CHECK(body.has_uv(), "the body '", body.name(), "' has no UV map, expected vt and ft");
  BODYLOOM_CHECK(d.vt.allFinite(), "the UV map of the body '", body.name(), "' holds NaN or infinite values");
  const int F = body.num_faces();
  // One id for each (position, u, v).
  std::map<std::tuple<int, float, float>, int> ids;
  std::vector<int> corner_id(3 * static_cast<size_t>(F));
  for (int f = 0; f < F; ++f) {
    for (int k = 0; k < 3; ++k) {
      const int uv = d.ft(f, k);
      corner_id[3 * f + k] =
          ids.try_emplace({d.faces(f, k), d.vt(uv, 0), d.vt(uv, 1)}, static_cast<int>(ids.size())).first->second;
    }
  }
  UvCharts charts;
  charts.mesh = BuildMeshAdjacency(d.faces, body.num_vertices());
  charts.is_seam.assign(3 * static_cast<size_t>(F), 1);
  std::vector<int> parent(F);
  std::iota(parent.begin(), parent.end(), 0);
  const auto ends = [&](int h) { return std::minmax(corner_id[h], corner_id[h - h % 3 + (h + 1) % 3]); };
  for (int h = 0; h < 3 * F; ++h) {
    const int other = charts.mesh.opposite[h];
    if (other < 0 || std::pair<int, int>(ends(h)) != std::pair<int, int>(ends(other))) continue;
    charts.is_seam[h] = 0;
    const int a = RootOf(parent, h / 3), b = RootOf(parent, other / 3);
    parent[std::max(a, b)] = std::min(a, b);
  }
  charts.chart.assign(F, -1);
  for (int f = 0; f < F; ++f) {
    const int root = RootOf(parent, f);  // the lowest face of its chart
    if (root == f) charts.chart[f] = charts.num_charts++;
    charts.chart[f] = charts.chart[root];
  }
  return charts;
}

}  // namespace bodyloom
