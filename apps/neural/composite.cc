// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/composite.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bodyloom {
namespace {

/// Where a row or column of the picture lies between two of the window's.
struct Between {
  int first = 0;
  float to_second = 0;
};

/// For `count` rows or columns of the picture.
std::vector<Between> Places(int count, double scale, int corner) {
  std::vector<Between> places(count);
  for (int i = 0; i < count; ++i) {
    const double at = (i + 0.5) * scale - 0.5 - corner, below = std::floor(at);
    places[i] = {static_cast<int>(below), static_cast<float>(at - below)};
  }
  return places;
}

}  // namespace

PictureSize SizeOfPictures(const PersonWindow& window, const Camera& camera, bool full_size) {
  if (full_size) return {camera.width, camera.height};
  return {window.picture_width, window.picture_height};
}

void Composite(std::span<const float> image, std::span<const float> alpha, const PersonWindow& window, int t,
               Image* picture) {
  const int width = window.width, height = window.height;
  const auto area = static_cast<size_t>(width) * height;
  const auto columns =
      Places(picture->width, static_cast<double>(window.picture_width) / picture->width, window.corner[t].x());
  const auto rows =
      Places(picture->height, static_cast<double>(window.picture_height) / picture->height, window.corner[t].y());
  for (int y = 0; y < picture->height; ++y) {
    const Between row = rows[y];
    if (row.first < -1 || row.first >= height) continue;
    for (int x = 0; x < picture->width; ++x) {
      const Between column = columns[x];
      if (column.first < -1 || column.first >= width) continue;
      const auto sample = [&](const float* plane) {
        float sum = 0;
        for (int v = 0; v < 2; ++v) {
          for (int u = 0; u < 2; ++u) {
            const int i = row.first + v, j = column.first + u;
            const float weight =
                (v == 0 ? 1 - row.to_second : row.to_second) * (u == 0 ? 1 - column.to_second : column.to_second);
            if (weight > 0 && i >= 0 && i < height && j >= 0 && j < width) sum += weight * plane[i * width + j];
          }
        }
        return sum;
      };
      const float behind = 1 - sample(alpha.data());
      uint8_t* to = picture->pixel(x, y);
      for (int c = 0; c < 3; ++c) {
        const float value = 255 * sample(image.data() + area * (2 - c)) + behind * static_cast<float>(to[c]);
        to[c] = static_cast<uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
      }
    }
  }
}

}  // namespace bodyloom
