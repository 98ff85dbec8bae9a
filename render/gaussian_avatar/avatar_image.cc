// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/avatar_image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "geometry/base/check.h"

namespace bodyloom {

void LayOver(const SplatImage& image, Image* whole) {
  const PixelBox& window = image.window();
  const std::span<const float> alpha = image.plane(SplatImage::kAlpha);
  for (int c = 0; c < 3; ++c) {
    const std::span<const float> plane = image.plane(static_cast<SplatImage::Plane>(2 - c));
    for (int y = window.y_begin; y < window.y_end; ++y) {
      for (int x = window.x_begin; x < window.x_end; ++x) {
        const size_t i = window.IndexOf(x, y);
        uint8_t& to = whole->pixel(x, y)[c];
        const float value = 255 * plane[i] + (1 - alpha[i]) * static_cast<float>(to);
        to = static_cast<uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
      }
    }
  }
}

std::vector<uint8_t> WithAlpha(const SplatImage& image, int width, int height) {
  std::vector<uint8_t> bgra(4 * static_cast<size_t>(width) * height, 0);
  const PixelBox& window = image.window();
  for (int y = window.y_begin; y < window.y_end; ++y) {
    for (int x = window.x_begin; x < window.x_end; ++x) {
      const size_t i = window.IndexOf(x, y);
      const float alpha = image.plane(SplatImage::kAlpha)[i];
      uint8_t* to = bgra.data() + 4 * (static_cast<size_t>(y) * width + x);
      const auto byte = [](float v) { return static_cast<uint8_t>(std::lround(255 * std::clamp(v, 0.0F, 1.0F))); };
      to[3] = byte(alpha);
      if (to[3] == 0) continue;
      for (int c = 0; c < 3; ++c) to[c] = byte(image.plane(static_cast<SplatImage::Plane>(2 - c))[i] / alpha);
    }
  }
  return bgra;
}

Image LabelsOf(const SplatImage& image, std::span<const float> garment, int width, int height) {
  const PixelBox& window = image.window();
  BODYLOOM_CHECK(garment.empty() || garment.size() == window.area(), "labels of an avatar: a garment of ",
                 garment.size(), " pixels for a window of ", window.area());
  const std::span<const float> alpha = image.plane(SplatImage::kAlpha);
  Image labels(width, height);
  for (int y = window.y_begin; y < window.y_end; ++y) {
    for (int x = window.x_begin; x < window.x_end; ++x) {
      const size_t i = window.IndexOf(x, y);
      const bool is_garment = !garment.empty() && garment[i] >= kMinGarmentShare;
      if (!is_garment && !(alpha[i] >= kMinAlpha)) continue;
      std::fill_n(labels.pixel(x, y), 3, static_cast<uint8_t>(is_garment ? PersonLabel::kBottom : PersonLabel::kSkin));
    }
  }
  return labels;
}

}  // namespace bodyloom
