// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/people/composite.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/pipelines/people/window_sampler.h"

namespace bodyloom {

PictureSize SizeOfPictures(const PersonWindow& window, const Camera& camera, bool full_size) {
  if (full_size) return {camera.width, camera.height};
  return {window.picture_width, window.picture_height};
}

void Composite(std::span<const float> image, std::span<const float> alpha, const PersonWindow& window, int t,
               Image* picture) {
  const auto area = static_cast<size_t>(window.width) * window.height;
  const WindowSampler window_at(window, t, picture->width, picture->height);
  for (int y = 0; y < picture->height; ++y) {
    if (window_at.RowIsOutside(y)) continue;
    for (int x = 0; x < picture->width; ++x) {
      if (window_at.ColumnIsOutside(x)) continue;
      const float behind = 1 - window_at.At(alpha, x, y);
      uint8_t* to = picture->pixel(x, y);
      for (int c = 0; c < 3; ++c) {
        const float value =
            255 * window_at.At(image.subspan(area * (2 - c), area), x, y) + behind * static_cast<float>(to[c]);
        to[c] = static_cast<uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
      }
    }
  }
}

}  // namespace bodyloom
