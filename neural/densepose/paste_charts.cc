// SPDX-License-Identifier: Apache-2.0
#include "neural/densepose/paste_charts.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// The two cells that a pixel lies between, and the weight of the second.
struct Tap {
  int low = 0, high = 0;
  float weight = 0;
};

/// Pixels along one axis whose centres lie in [begin, end), and their taps on a grid of `cells` over it.
struct Span {
  Span(double begin, double end, int pixels, int cells) {
    if (!(end > begin) || !std::isfinite(begin) || !std::isfinite(end)) return;
    first = int(std::clamp(std::ceil(begin - 0.5), 0.0, double(pixels)));
    const int last = int(std::clamp(std::ceil(end - 0.5), 0.0, double(pixels)));
    for (int i = first; i < last; ++i) {
      const double at = std::clamp((i + 0.5 - begin) * cells / (end - begin) - 0.5, 0.0, cells - 1.0);
      const int low = int(at);
      taps.push_back({low, std::min(low + 1, cells - 1), float(at - low)});
    }
  }
  int first = 0;
  std::vector<Tap> taps;
};

float Interpolate(const float* plane, int width, const Tap& row, const Tap& column) {
  const float* above = plane + int64_t(row.low) * width;
  const float* below = plane + int64_t(row.high) * width;
  const float top = above[column.low] + column.weight * (above[column.high] - above[column.low]);
  const float bottom = below[column.low] + column.weight * (below[column.high] - below[column.low]);
  return top + row.weight * (bottom - top);
}

}  // namespace

ChartImage PasteCharts(const ChartPlanes& planes, const ChartDetection& box, int image_width, int image_height) {
  BODYLOOM_CHECK(planes.coarse_channels >= 2 && planes.height > 0 && planes.width > 0,
                 "chart planes: ", planes.coarse_channels, " coarse channels of ", planes.height, " x ", planes.width,
                 " cells");
  const Span columns(box.x0, box.x1, image_width, planes.width), rows(box.y0, box.y1, image_height, planes.height);
  ChartImage image;
  image.x_begin = columns.first;
  image.y_begin = rows.first;
  image.width = int(columns.taps.size());
  image.height = int(rows.taps.size());
  const size_t num_pixels = columns.taps.size() * rows.taps.size();
  image.part.assign(num_pixels, 0);
  image.u.assign(num_pixels, 0);
  image.v.assign(num_pixels, 0);
  const int64_t cells = int64_t(planes.height) * planes.width;
  size_t i = 0;
  for (const Tap& row : rows.taps) {
    for (const Tap& column : columns.taps) {
      const auto at = [&](const float* channels, int k) {
        return Interpolate(channels + k * cells, planes.width, row, column);
      };
      const auto strongest = [&](const float* channels, int count) {
        int best = 0;
        float maximum = at(channels, 0);
        for (int k = 1; k < count; ++k) {
          const float logit = at(channels, k);
          if (logit > maximum) maximum = logit, best = k;
        }
        return best;
      };
      const int part =
          strongest(planes.coarse, planes.coarse_channels) > 0 ? strongest(planes.fine, ChartPlanes::kFine) : 0;
      const float u = at(planes.u, part), v = at(planes.v, part);
      if (part > 0 && std::isfinite(u) && std::isfinite(v)) {
        image.part[i] = uint8_t(part);
        image.u[i] = std::clamp(u, 0.0F, 1.0F);
        image.v[i] = std::clamp(v, 0.0F, 1.0F);
      }
      ++i;
    }
  }
  return image;
}

}  // namespace bodyloom
