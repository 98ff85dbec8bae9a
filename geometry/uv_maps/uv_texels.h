// SPDX-License-Identifier: Apache-2.0
/// The surface point of each texel of a UV map. Computed once per body and map size; baking is then one weighted sum of
/// three vertices per texel (geometry/uv_maps/uv_bake.h).
///
/// Texel (row r, column c) of an H×W map is centred at u = (c + 0.5)/W, v = 1 − (r + 0.5)/H. It shows the face whose UV
/// triangle holds its centre, at the centre's barycentric coordinates; of several faces the lowest.
///
/// Gutter: so that a bilinear lookup next to a seam is right, the texels around a chart continue its surface. Such a
/// texel shows the face ACROSS the seam: the surface is unrolled over the edge in the template's metric and followed as
/// far as the texel lies from it. At a mesh boundary, the boundary's value is extended. Comparison with no gutter and
/// with nearest dilation: docs/lab/descriptors.md.
///
/// Irregularities of a UV map are counted: parts outside [0,1]² are not shown (no wrapping); faces without area in UV
/// show nothing; overlaps go to the lowest face; a texel in the gutter of two charts goes to the nearer one, and
/// lookups that check charts (render/texture/uv_sample.h) skip it for the other.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/uv_maps/uv_charts.h"

namespace bodyloom {

struct UvTexelOptions {
  int width = 128, height = 128;  ///< 1 to 16384, at most 2^26 texels
  int gutter = 1;                 ///< width around every chart in texels, 0 to 64; 1 is what bilinear lookup needs
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct UvTexelTable {
  int width = 0, height = 0;
  /// One entry per texel that shows the surface, in row order.
  std::vector<int> pixel;  ///< row · width + column
  std::vector<int> face;
  std::vector<Eigen::Vector3f> barycentric;  ///< ≥ 0, sums to 1
  std::vector<uint8_t> in_gutter;
  std::vector<int> chart_at;  ///< H·W: the chart that a texel belongs to (gutter: whose gutter it is), −1: none

  int num_charts = 0;
  int num_inside = 0, num_gutter = 0;  ///< texels
  int overlapping = 0;                 ///< texels inside two faces or more
  int contested = 0;                   ///< texels in the gutter of one chart that belong to another
  int faces_without_area = 0;          ///< in UV
  int faces_outside = 0;               ///< wholly or in part outside [0,1]²
  [[nodiscard]] size_t size() const { return pixel.size(); }
  /// Share of all texels that show the surface, gutter not counted.
  [[nodiscard]] double Coverage() const { return double(num_inside) / (double(width) * height); }
};

/// O(texels + faces). Throws std::invalid_argument when options are not valid, the body has no UV or one that is not
/// finite, or no texel centre lies on any chart.
UvTexelTable BuildUvTexelTable(const BodyModel& body, const UvTexelOptions& options = {});
UvTexelTable BuildUvTexelTable(const BodyModel& body, const UvCharts& charts, const UvTexelOptions& options = {});

}  // namespace bodyloom
