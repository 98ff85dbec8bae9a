// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/uv_splat.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

using Eigen::Vector2d;

namespace {

constexpr double kLargestRadius = 12;  ///< texels; a longer step between neighbours is a jump, not a stretch

}  // namespace

UvSplatter::UvSplatter(const BodyModel& body, const UvTexelOptions& texels)
    : body_(body),
      charts_(FindUvCharts(body)),
      table_(BuildUvTexelTable(body, charts_, texels)),
      lookup_(body),
      sum_(3 * size_t(table_.width) * table_.height, 0.0F),
      weight_(size_t(table_.width) * table_.height, 0.0F) {}

int UvSplatter::Add(const Image& image, std::span<const uint8_t> part, std::span<const float> u,
                    std::span<const float> v) {
  const size_t n = size_t(image.width) * image.height;
  BODYLOOM_CHECK(part.size() == n && u.size() == n && v.size() == n, "splat: labels of ", part.size(), ", ", u.size(),
                 " and ", v.size(), " pixels, expected ", image.width, " x ", image.height);
  std::vector<UvPoint> points(n);
  for (size_t i = 0; i < n; ++i) {
    if (part[i] == 0 || part[i] > 24 || !std::isfinite(u[i]) || !std::isfinite(v[i])) continue;
    const auto surface = lookup_.Find(part[i], {u[i], v[i]});
    if (surface.face >= 0) points[i] = UvPointAt(body_, charts_, surface.face, surface.barycentric);
  }
  const auto texel = [&](size_t i) {
    return Vector2d(points[i].uv.x() * table_.width - 0.5, (1 - points[i].uv.y()) * table_.height - 0.5);
  };
  const size_t texels = weight_.size();
  int used = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const size_t i = size_t(y) * image.width + x;
      if (points[i].chart < 0) continue;
      ++used;
      const Vector2d centre = texel(i);
      // Half the step to the neighbours is where this pixel ends; a little more, so that pixels overlap.
      double radius = 1;
      const auto reach = [&](int nx, int ny) {
        if (nx < 0 || ny < 0 || nx >= image.width || ny >= image.height) return;
        const size_t j = size_t(ny) * image.width + nx;
        if (points[j].chart != points[i].chart) return;
        const double step = (texel(j) - centre).norm();
        if (step <= 2 * kLargestRadius) radius = std::max(radius, 0.75 * step);
      };
      reach(x - 1, y);
      reach(x + 1, y);
      reach(x, y - 1);
      reach(x, y + 1);
      const uint8_t* bgr = image.pixel(x, y);
      const int column_last = std::min(table_.width - 1, static_cast<int>(std::floor(centre.x() + radius)));
      const int row_last = std::min(table_.height - 1, static_cast<int>(std::floor(centre.y() + radius)));
      for (int row = std::max(0, static_cast<int>(std::ceil(centre.y() - radius))); row <= row_last; ++row) {
        for (int column = std::max(0, static_cast<int>(std::ceil(centre.x() - radius))); column <= column_last;
             ++column) {
          const size_t p = size_t(row) * table_.width + column;
          if (table_.chart_at[p] != points[i].chart) continue;
          const double distance = (Vector2d(column, row) - centre).norm();
          if (distance >= radius) continue;
          const auto w = static_cast<float>((1 - distance / radius) / (radius * radius));
          weight_[p] += w;
          for (int c = 0; c < 3; ++c) sum_[c * texels + p] += w * static_cast<float>(bgr[c]) / 255;
        }
      }
    }
  }
  return used;
}

Texture UvSplatter::Merge() const {
  Texture texture;
  texture.width = table_.width;
  texture.height = table_.height;
  const size_t texels = weight_.size();
  texture.bgr.assign(3 * texels, 0.0F);
  texture.confidence.assign(texels, 0.0F);
  texture.source_frame.assign(texels, -1);
  texture.source_x_px.assign(texels, 0.0F);
  texture.source_y_px.assign(texels, 0.0F);
  for (size_t p = 0; p < texels; ++p) {
    if (!(weight_[p] > 1e-4F)) continue;
    ++texture.num_seen;
    texture.confidence[p] = std::min(1.0F, weight_[p]);
    for (int c = 0; c < 3; ++c) texture.bgr[c * texels + p] = sum_[c * texels + p] / weight_[p];
  }
  return texture;
}

}  // namespace bodyloom
