// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/descriptors/texels_of_pixels.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;

constexpr double kFarthest = 0.1;  ///< of the atlas: pixels farther apart there lie on different sheets of the surface
constexpr double kInside = 1e-6;   ///< of barycentric coordinates: beyond the triangle
constexpr double kHalfAPixel = 0.5;

struct Corner {
  Vector2d pixel, texel;
};

/// Texels whose centres lie within the triangle, or no farther beyond it than `beyond`, and which nothing showed yet.
void FillTriangle(const std::array<Corner, 3>& corners, double beyond, uint8_t part,
                  std::span<const uint8_t> texel_parts, int U, TexelPlaces* places) {
  const Vector2d a = corners[0].texel, ab = corners[1].texel - a, ac = corners[2].texel - a;
  if (std::max({ab.norm(), ac.norm(), (ab - ac).norm()}) > kFarthest * U) return;
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  if (area == 0) return;
  const Vector2d lowest = a.cwiseMin(corners[1].texel).cwiseMin(corners[2].texel),
                 highest = a.cwiseMax(corners[1].texel).cwiseMax(corners[2].texel);
  // A coordinate of −beyond is as far from the triangle as so much of its extent, twice where two are.
  const Vector2d margin = 2 * beyond * (highest - lowest), low = lowest - margin, high = highest + margin;
  for (int r = std::max(0, static_cast<int>(std::ceil(low.y()))); r <= std::min<double>(U - 1, high.y()); ++r) {
    for (int c = std::max(0, static_cast<int>(std::ceil(low.x()))); c <= std::min<double>(U - 1, high.x()); ++c) {
      const size_t at = size_t(r) * U + c;
      if (texel_parts[at] != part || places->seen[at] != 0) continue;
      const Vector2d p = Vector2d(c, r) - a;
      const double of_b = (p.x() * ac.y() - p.y() * ac.x()) / area, of_c = (ab.x() * p.y() - ab.y() * p.x()) / area;
      if (std::min({of_b, of_c, 1 - of_b - of_c}) < -beyond) continue;
      const Vector2d pixel = (1 - of_b - of_c) * corners[0].pixel + of_b * corners[1].pixel + of_c * corners[2].pixel;
      places->seen[at] = 1;
      places->pixels[at] = static_cast<float>(pixel.x());
      places->pixels[size_t(U) * U + at] = static_cast<float>(pixel.y());
    }
  }
}

}  // namespace

TexelPlaces TexelsOfPixels(std::span<const float> uv, std::span<const uint8_t> parts, int width, int height,
                           std::span<const uint8_t> texel_parts, int texture_size) {
  const int U = texture_size;
  const size_t area = size_t(width) * height, texels = size_t(U) * U;
  BODYLOOM_CHECK(uv.size() == 2 * area && parts.size() == area && texel_parts.size() == texels,
                 "texels of pixels: coordinates, parts and texels of ", uv.size(), ", ", parts.size(), " and ",
                 texel_parts.size(), " values, expected those of ", width, "x", height, " and of ", U, "x", U);
  TexelPlaces places = {std::vector<float>(2 * texels, 0), std::vector<float>(texels, 0)};
  const auto corner = [&](int x, int y) {
    const size_t i = size_t(y) * width + x;
    return Corner{Vector2d(x, y), Vector2d(uv[i] * U - 0.5, (1 - uv[area + i]) * U - 0.5)};
  };
  const auto part = [&](int x, int y) { return parts[size_t(y) * width + x]; };
  // Last what lies at the rim of the pixels that show a part: a pixel stands for half of one around its centre.
  for (const double beyond : {kInside, kHalfAPixel}) {
    for (int y = 0; y + 1 < height; ++y) {
      for (int x = 0; x + 1 < width; ++x) {
        // The diagonal from upper right to lower left is in both halves of the square.
        const uint8_t shared = part(x + 1, y);
        if (shared == 0 || shared != part(x, y + 1)) continue;
        const Corner right = corner(x + 1, y), below = corner(x, y + 1);
        for (const int k : {0, 1}) {
          if (part(x + k, y + k) != shared) continue;
          FillTriangle({corner(x + k, y + k), right, below}, beyond, shared, texel_parts, U, &places);
        }
      }
    }
  }
  return places;
}

}  // namespace bodyloom
