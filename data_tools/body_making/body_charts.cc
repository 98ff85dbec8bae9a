// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/body_charts.h"

#include <algorithm>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr double kPartMargin = 0.02;

/// (u,v) inside the part of box coordinates of the left half.
Eigen::Vector2d PartFromBox(const ChartKind& kind, const Eigen::Vector2d& box, bool is_right) {
  const double low = kind.slot == 2 ? 0.5 + kPartMargin : kPartMargin;
  const double high = kind.slot == 1 ? 0.5 - kPartMargin : 1 - kPartMargin;
  const double u = low + (high - low) * box.x();
  return {is_right ? 1 - u : u, kPartMargin + (1 - 2 * kPartMargin) * box.y()};
}

}  // namespace

const std::array<ChartKind, 15>& ChartKinds() {
  static constexpr std::array<ChartKind, 15> kKinds = {{{"torsoB", 1, 1, 0},
                                                        {"torsoF", 2, 2, 0},
                                                        {"handD", 4, 3, 1},
                                                        {"handP", 4, 3, 2},
                                                        {"footT", 5, 6, 1},
                                                        {"footS", 5, 6, 2},
                                                        {"ulegB", 8, 7, 0},
                                                        {"ulegF", 10, 9, 0},
                                                        {"llegB", 12, 11, 0},
                                                        {"llegF", 14, 13, 0},
                                                        {"uarmI", 15, 16, 0},
                                                        {"uarmO", 17, 18, 0},
                                                        {"larmI", 19, 20, 0},
                                                        {"larmO", 21, 22, 0},
                                                        {"head", 24, 23, 0}}};
  return kKinds;
}

int NumChartIslands() {
  int islands = 0;
  for (const ChartKind& kind : ChartKinds()) islands += kind.spans_both_halves() ? 1 : 2;
  return islands;
}

int FindChartKind(const std::string& name) {
  const auto& kinds = ChartKinds();
  const auto it = std::find_if(kinds.begin(), kinds.end(), [&](const ChartKind& kind) { return name == kind.name; });
  return it == kinds.end() ? -1 : static_cast<int>(it - kinds.begin());
}

ChartedFaces BuildCharts(const std::vector<Quad>& quads, const std::vector<int>& quad_chart,
                         const std::vector<bool>& quad_is_right, const std::vector<int>& vertex_mirror,
                         const std::vector<ChartCoordinates>& charts,
                         const std::vector<Eigen::Matrix<double, 2, 3>>& atlas_from_chart) {
  const int num_kinds = static_cast<int>(ChartKinds().size());
  BODYLOOM_CHECK(quad_chart.size() == quads.size() && quad_is_right.size() == quads.size(), "charts of ",
                 quad_chart.size(), " quads, the mesh has ", quads.size());
  BODYLOOM_CHECK(static_cast<int>(charts.size()) == num_kinds, charts.size(), " charts, expected ", num_kinds);
  BODYLOOM_CHECK(static_cast<int>(atlas_from_chart.size()) == NumChartIslands(), atlas_from_chart.size(),
                 " atlas placements, expected ", NumChartIslands());

  std::vector<std::vector<int>> members(num_kinds);  // left-half vertices, increasing
  std::vector<std::vector<int>> quads_of_kind(num_kinds);
  for (size_t q = 0; q < quads.size(); ++q) {
    BODYLOOM_CHECK(quad_chart[q] >= 0 && quad_chart[q] < num_kinds, "quad ", q, " has chart ", quad_chart[q]);
    quads_of_kind[quad_chart[q]].push_back(static_cast<int>(q));
    if (quad_is_right[q]) continue;
    members[quad_chart[q]].insert(members[quad_chart[q]].end(), quads[q].begin(), quads[q].end());
  }

  ChartedFaces faces;
  const auto num_faces = 2 * static_cast<Eigen::Index>(quads.size());
  faces.ft.resize(num_faces, 3);
  faces.face_iuv.resize(num_faces, 6);
  faces.face_part.resize(num_faces);
  std::vector<Eigen::Vector2d> vt, in_part;      // by UV vertex
  std::array<std::vector<int>, 2> uv_of_vertex;  // of the chart at hand, left and right; −1: none
  int island = 0;
  for (int c = 0; c < num_kinds; ++c) {
    const ChartKind& kind = ChartKinds()[c];
    std::sort(members[c].begin(), members[c].end());
    members[c].erase(std::unique(members[c].begin(), members[c].end()), members[c].end());
    BODYLOOM_CHECK(members[c].size() == charts[c].uv.size(), "chart ", kind.name, " has ", charts[c].uv.size(),
                   " coordinates for ", members[c].size(), " vertices of the left half");
    // UV vertices of the left half, then of its mirror image. On the mirror plane a chart that spans both halves has
    // one UV vertex, not two.
    for (int side = 0; side < 2; ++side) {
      uv_of_vertex[side].assign(vertex_mirror.size(), -1);
      for (size_t i = 0; i < members[c].size(); ++i) {
        const int v = members[c][i];
        const bool is_shared = side == 1 && kind.spans_both_halves() && vertex_mirror[v] == v;
        uv_of_vertex[side][side == 0 ? v : vertex_mirror[v]] =
            is_shared ? uv_of_vertex[0][v] : static_cast<int>(vt.size());
        if (is_shared) continue;
        const Eigen::Vector2d& left_box = charts[c].uv[i];
        in_part.push_back(PartFromBox(kind, left_box, side == 1));
        vt.push_back(atlas_from_chart[island] *
                     Eigen::Vector3d(side == 0 ? left_box.x() : 1 - left_box.x(), left_box.y(), 1));
      }
      if (side == 1 || !kind.spans_both_halves()) ++island;
    }
    for (int q : quads_of_kind[c]) {
      for (int half = 0; half < 2; ++half) {
        const Eigen::Index f = 2 * q + half;
        faces.face_part[f] = quad_is_right[q] ? kind.right_part : kind.left_part;
        const std::array<int, 3> triangle = half == 0 ? std::array<int, 3>{0, 1, 2} : std::array<int, 3>{0, 2, 3};
        for (int k = 0; k < 3; ++k) {
          const int uv_vertex = uv_of_vertex[quad_is_right[q] ? 1 : 0][quads[q][triangle[k]]];
          BODYLOOM_CHECK(uv_vertex >= 0, "quad ", q, " of chart ", kind.name, " has no mirror image in the left half");
          faces.ft(f, k) = uv_vertex;
          faces.face_iuv.block<1, 2>(f, 2 * k) = in_part[uv_vertex].transpose().cast<float>();
        }
      }
    }
  }
  faces.vt.resize(static_cast<Eigen::Index>(vt.size()), 2);
  for (size_t i = 0; i < vt.size(); ++i) faces.vt.row(static_cast<Eigen::Index>(i)) = vt[i].transpose().cast<float>();
  return faces;
}

}  // namespace bodyloom
