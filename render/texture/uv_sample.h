// SPDX-License-Identifier: Apache-2.0
/// Samples UV maps into the image: Π of Yoon et al. (eq. 5), f(x) = f_uv(u(x)), with derivatives by (u, v).
///
/// Lookups are bilinear in float (cv::remap rounds coordinates to 1/32 of a texel) and check charts: taps in another
/// chart, or in none, are excluded and the others are normalised to sum 1. Hence adjacent charts do not bleed into each
/// other, and the map's gutter (geometry/uv_maps/uv_texels.h) makes lookups at a seam exact.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/uv_maps/uv_charts.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/raster/visible_points.h"

namespace bodyloom {

/// A point of the atlas.
struct UvPoint {
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  int chart = -1;
};

UvPoint UvPointAt(const BodyModel& body, const UvCharts& charts, int face, const Eigen::Vector3d& barycentric);

/// The texels of a lookup: value = Σ weight · map[pixel], ∂value/∂(u, v) = Σ d_weight · map[pixel].
struct UvTaps {
  int count = 0;  ///< 0: no texel of the chart is near, the value is 0
  std::array<int, 4> pixel{};
  std::array<double, 4> weight{};
  std::array<Eigen::Vector2d, 4> d_weight;  ///< by u and v
  bool whole = false;                       ///< all four texels belong to the chart
};

UvTaps TapsAt(const UvTexelTable& table, const UvPoint& point);

/// Samples C maps (C planes of the table's size) at the visible points: C planes of width × height, zero elsewhere.
/// `points` come from ResolveVisiblePoints. Throws std::invalid_argument when sizes do not fit.
std::vector<float> ProjectUvMaps(const BodyModel& body, const UvCharts& charts, const UvTexelTable& table,
                                 std::span<const float> maps, int num_channels, const VisiblePoints& points, int width,
                                 int height);

}  // namespace bodyloom
