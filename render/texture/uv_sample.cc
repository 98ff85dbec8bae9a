// SPDX-License-Identifier: Apache-2.0
#include "render/texture/uv_sample.h"

#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {

using Eigen::Vector2d;

UvPoint UvPointAt(const BodyModel& body, const UvCharts& charts, int face, const Eigen::Vector3d& barycentric) {
  UvPoint point;
  for (int k = 0; k < 3; ++k) {
    point.uv += barycentric[k] * body.data().vt.row(body.data().ft(face, k)).transpose().cast<double>();
  }
  point.chart = charts.chart[face];
  return point;
}

UvTaps TapsAt(const UvTexelTable& table, const UvPoint& point) {
  UvTaps taps;
  const double x = point.uv.x() * table.width - 0.5, y = (1 - point.uv.y()) * table.height - 0.5;
  if (!(std::abs(x) < 1e6 && std::abs(y) < 1e6)) return taps;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const double fx = x - x0, fy = y - y0;
  double sum = 0;
  Vector2d d_sum = Vector2d::Zero();
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const int column = x0 + i, row = y0 + j;
      if (column < 0 || row < 0 || column >= table.width || row >= table.height) continue;
      const int pixel = row * table.width + column;
      if (table.chart_at[pixel] != point.chart) continue;
      const double wx = i ? fx : 1 - fx, wy = j ? fy : 1 - fy;
      taps.pixel[taps.count] = pixel;
      taps.weight[taps.count] = wx * wy;
      taps.d_weight[taps.count] = Vector2d((i ? 1 : -1) * wy * table.width, -(j ? 1 : -1) * wx * table.height);
      sum += taps.weight[taps.count];
      d_sum += taps.d_weight[taps.count];
      ++taps.count;
    }
  }
  taps.whole = taps.count == 4;
  if (taps.whole) return taps;
  if (!(sum > 1e-9)) {  // the point lies on the boundary of texels outside the chart
    taps.count = 0;
    return taps;
  }
  for (int k = 0; k < taps.count; ++k) {  // w / Σw and its derivative
    taps.d_weight[k] = (taps.d_weight[k] - taps.weight[k] / sum * d_sum) / sum;
    taps.weight[k] /= sum;
  }
  return taps;
}

std::vector<float> ProjectUvMaps(const BodyModel& body, const UvCharts& charts, const UvTexelTable& table,
                                 std::span<const float> maps, int num_channels, const VisiblePoints& points, int width,
                                 int height) {
  const size_t texels = size_t(table.width) * table.height, pixels = size_t(width) * height;
  BODYLOOM_CHECK(num_channels > 0 && maps.size() == texels * num_channels, "UV maps of ", maps.size(),
                 " values, expected ", num_channels, " x ", table.height, " x ", table.width);
  std::vector<float> image(pixels * num_channels, 0.0F);
  for (size_t i = 0; i < points.size(); ++i) {
    BODYLOOM_CHECK(points.x[i] >= 0 && points.x[i] < width && points.y[i] >= 0 && points.y[i] < height,
                   "a visible point at pixel ", points.x[i], " ", points.y[i], ", expected an image of ", width, "x",
                   height);
    const UvTaps taps = TapsAt(table, UvPointAt(body, charts, points.face[i], points.barycentric[i]));
    const size_t at = size_t(points.y[i]) * width + points.x[i];
    for (int c = 0; c < num_channels; ++c) {
      double value = 0;
      for (int k = 0; k < taps.count; ++k) value += taps.weight[k] * maps[texels * c + taps.pixel[k]];
      image[pixels * c + at] = static_cast<float>(value);
    }
  }
  return image;
}

}  // namespace bodyloom
