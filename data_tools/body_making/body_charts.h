// SPDX-License-Identifier: Apache-2.0
/// DensePose-style charts of the built-in body: the part id (1–24) of each face, its (u,v) inside the part, and the
/// packed atlas.
///
/// Fifteen chart kinds cover the left half; their mirror images cover the right half. The two torso charts span both
/// halves, each other kind makes one island per side: 28 islands. Hands and feet have two islands per part.
///   part ids (left/right)  torso back 1, front 2; hand 4/3; foot 5/6; upper leg back 8/7, front 10/9; lower leg back
///   12/11, front 14/13; upper arm inner 15/16, outer 17/18; lower arm inner 19/20, outer 21/22; head with neck 24/23
///   inside the part        the chart's bounding box fills [.02,.98]²; of a two-island part the first (back of the
///   hand, top of the foot) fills u in [.02,.48], the second [.52,.98] on the left side; the right side is u → 1 − u
/// v up: towards the head (torso, legs, head), the shoulder (arms), the finger and toe tips (hands, feet).
/// Why "inner" and "outer" arms: docs/lab/built_in_body.md, "Charts against a detector's labels".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "data_tools/body_making/cage.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

struct ChartKind {
  const char* name;
  uint8_t left_part, right_part;  ///< equal: one island across both halves
  int slot;                       ///< 0: the whole part, 1 or 2: first or second island of a two-island part
  [[nodiscard]] bool spans_both_halves() const { return left_part == right_part; }
};

/// The kinds in the order of the body's file.
const std::array<ChartKind, 15>& ChartKinds();

/// Number of islands: one for a kind that spans both halves, two (left, right) for the others; islands are numbered in
/// the order of the kinds, left before right.
int NumChartIslands();

/// Index into ChartKinds() or −1.
int FindChartKind(const std::string& name);

/// Left-half coordinates of one chart kind inside its bounding box.
struct ChartCoordinates {
  std::vector<Eigen::Vector2d>
      uv;  ///< in [0,1]², one for each left-half vertex of the chart, by increasing vertex index
};

struct ChartedFaces {
  MatrixX2f vt;                    ///< atlas coordinates, v up
  MatrixX3i ft;                    ///< 2Q×3
  std::vector<uint8_t> face_part;  ///< 2Q
  RowMatrixXf face_iuv;            ///< 2Q×6
};

/// Charts of the triangles of `quads` (two a quad, as TrianglesOfQuads). quad_chart gives each quad's kind,
/// quad_is_right its side, vertex_mirror the mirror image of each vertex; atlas_from_chart maps (x,y,1) of each
/// island's bounding box to the atlas. Throws std::invalid_argument when a chart has another number of vertices than
/// coordinates.
ChartedFaces BuildCharts(const std::vector<Quad>& quads, const std::vector<int>& quad_chart,
                         const std::vector<bool>& quad_is_right, const std::vector<int>& vertex_mirror,
                         const std::vector<ChartCoordinates>& charts,
                         const std::vector<Eigen::Matrix<double, 2, 3>>& atlas_from_chart);

}  // namespace bodyloom
