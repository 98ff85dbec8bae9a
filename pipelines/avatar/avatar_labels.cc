// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/avatar/avatar_labels.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

Image LabelsOf(const SplatPicture& picture, std::span<const float> garment, int width, int height) {
  const PixelBox& window = picture.window();
  BODYLOOM_CHECK(garment.empty() || garment.size() == window.area(), "labels of an avatar: a garment of ",
                 garment.size(), " pixels for a window of ", window.area());
  const std::span<const float> alpha = picture.plane(SplatPicture::kAlpha);
  Image labels(width, height);
  for (int y = window.y_begin; y < window.y_end; ++y) {
    for (int x = window.x_begin; x < window.x_end; ++x) {
      const size_t i = window.IndexOf(x, y);
      const bool is_garment = !garment.empty() && garment[i] >= kLeastGarmentShare;
      if (!is_garment && !(alpha[i] >= kLeastAlpha)) continue;
      std::fill_n(labels.pixel(x, y), 3, static_cast<uint8_t>(is_garment ? PersonLabel::kBottom : PersonLabel::kSkin));
    }
  }
  return labels;
}

}  // namespace bodyloom
