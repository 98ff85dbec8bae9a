// SPDX-License-Identifier: Apache-2.0
/// Reference implementation of the visibility buffer in its simplest form: every face against every pixel of its
/// bounding box (or of the whole image), whole-image arrays, no increments, no tiles, no vectors.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

struct TwinImage {
  int width = 0, height = 0;
  std::vector<int32_t> face;     ///< −1: background
  std::vector<float> nearness;   ///< −infinity: background
  std::vector<uint16_t> covers;  ///< number of faces that cover the pixel, hidden ones included
};

/// All vertices must project (none behind the camera or outside the lens' field). `every_pixel`: do not use bounding
/// boxes.
inline TwinImage RasterTwin(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera,
                            bool cull_back_faces, bool every_pixel = false) {
  struct Corner {
    int64_t x, y;
    float nearness;
  };
  std::vector<Corner> corners;
  for (int v = 0; v < vertices.rows(); ++v) {
    const Eigen::Vector3d X = vertices.row(v);
    Eigen::Vector2d pixel;
    if (!camera.Project(X, &pixel)) throw std::invalid_argument("twin: a vertex does not project");
    const double nearness = camera.model == CameraModel::kPinhole ? 1 / X.z() : -X.z();
    corners.push_back({static_cast<int64_t>(std::floor(pixel.x() * 256 + 0.5)),
                       static_cast<int64_t>(std::floor(pixel.y() * 256 + 0.5)), static_cast<float>(nearness)});
  }
  TwinImage image;
  image.width = camera.width, image.height = camera.height;
  const size_t size = size_t(camera.width) * camera.height;
  image.face.assign(size, -1);
  image.nearness.assign(size, -std::numeric_limits<float>::infinity());
  image.covers.assign(size, 0);
  for (int f = 0; f < faces.rows(); ++f) {
    std::array<Corner, 3> p = {corners[faces(f, 0)], corners[faces(f, 1)], corners[faces(f, 2)]};
    const auto area_of = [&] { return (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x); };
    if (area_of() == 0 || (area_of() > 0 && cull_back_faces)) continue;
    if (area_of() < 0) std::swap(p[1], p[2]);
    const int64_t area = area_of();
    const auto [x_low, x_high] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [y_low, y_high] = std::minmax({p[0].y, p[1].y, p[2].y});
    const bool small =
        static_cast<float>(x_high - x_low + 34 * 256) * static_cast<float>(y_high - y_low + 2 * 256) < 1.07e9F;
    const auto first = [&](int64_t low) { return every_pixel ? 0 : std::max<int64_t>(0, low / 256 - 1); };
    const auto last = [&](int64_t high, int end) { return every_pixel ? end : std::min<int64_t>(end, high / 256 + 2); };
    for (int64_t y = first(y_low); y < last(y_high, camera.height); ++y) {
      for (int64_t x = first(x_low); x < last(x_high, camera.width); ++x) {
        std::array<int64_t, 3> edge;
        std::array<int, 3> bias;
        bool inside = true;
        for (int c = 0; c < 3; ++c) {
          const Corner &q = p[(c + 1) % 3], &r = p[(c + 2) % 3];
          const int64_t dx = r.x - q.x, dy = r.y - q.y;
          const bool top = dy == 0 && dx > 0, left = dy < 0;
          bias[c] = top || left ? 0 : 1;
          edge[c] = dx * (y * 256 - q.y) - dy * (x * 256 - q.x) - bias[c];
          inside = inside && edge[c] >= 0;
        }
        if (!inside) continue;
        float nearness;
        if (small) {
          const float slope_b = (p[1].nearness - p[0].nearness) / static_cast<float>(area);
          const float slope_c = (p[2].nearness - p[0].nearness) / static_cast<float>(area);
          const float at_b = static_cast<float>(bias[1]) * slope_b, at_c = static_cast<float>(bias[2]) * slope_c;
          const float by_b = static_cast<float>(edge[1]) * slope_b, by_c = static_cast<float>(edge[2]) * slope_c;
          nearness = (p[0].nearness + (at_b + at_c)) + (by_b + by_c);
        } else {
          const double slope_b = (double{p[1].nearness} - p[0].nearness) / static_cast<double>(area);
          const double slope_c = (double{p[2].nearness} - p[0].nearness) / static_cast<double>(area);
          const double at_b = bias[1] * slope_b, at_c = bias[2] * slope_c;
          const double by_b = static_cast<double>(edge[1]) * slope_b, by_c = static_cast<double>(edge[2]) * slope_c;
          nearness = static_cast<float>((p[0].nearness + (at_b + at_c)) + (by_b + by_c));
        }
        const size_t at = size_t(y) * camera.width + x;
        ++image.covers[at];
        if (nearness > image.nearness[at]) {  // faces rise: at a tie the lowest stays
          image.nearness[at] = nearness;
          image.face[at] = f;
        }
      }
    }
  }
  return image;
}

}  // namespace bodyloom
