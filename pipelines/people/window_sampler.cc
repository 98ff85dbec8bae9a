// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/people/window_sampler.h"

namespace bodyloom {

WindowSampler::WindowSampler(const PersonWindow& window, int t, int picture_width, int picture_height)
    : width_(window.width),
      height_(window.height),
      columns_(Places(picture_width, static_cast<double>(window.picture_width) / picture_width, window.corner[t].x())),
      rows_(Places(picture_height, static_cast<double>(window.picture_height) / picture_height, window.corner[t].y())) {
}

std::vector<WindowSampler::Between> WindowSampler::Places(int count, double scale, int corner) {
  std::vector<Between> places(count);
  for (int i = 0; i < count; ++i) {
    const double at = (i + 0.5) * scale - 0.5 - corner, below = std::floor(at);
    places[i] = {static_cast<int>(below), static_cast<float>(at - below)};
  }
  return places;
}

float WindowSampler::At(std::span<const float> plane, int x, int y) const {
  const Between row = rows_[y], column = columns_[x];
  float sum = 0;
  for (int v = 0; v < 2; ++v) {
    for (int u = 0; u < 2; ++u) {
      const int i = row.first + v, j = column.first + u;
      const float weight =
          (v == 0 ? 1 - row.to_second : row.to_second) * (u == 0 ? 1 - column.to_second : column.to_second);
      if (weight > 0 && i >= 0 && i < height_ && j >= 0 && j < width_) sum += weight * plane[i * width_ + j];
    }
  }
  return sum;
}

int WindowSampler::Nearest(int x, int y) const {
  const int i = rows_[y].first + (rows_[y].to_second >= 0.5F ? 1 : 0);
  const int j = columns_[x].first + (columns_[x].to_second >= 0.5F ? 1 : 0);
  return i >= 0 && i < height_ && j >= 0 && j < width_ ? i * width_ + j : -1;
}

}  // namespace bodyloom
