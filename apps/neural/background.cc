// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/background.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "data_tools/video/image_file.h"

namespace bodyloom {
PhotoBackground ParsePhotoBackground(const std::string& option) {
  PhotoBackground result;
  result.own = option == "photo";
  if (!result.own && option != "studio") result.path = option;
  return result;
}

Background::Background(const std::string& path, int width, int height) : width_(width), height_(height) {
  if (path.empty()) {
    image_ = StudioBackdrop(width, height);
  } else if (IsImageName(path)) {
    image_ = Resized(ReadImage(path), width, height);
  } else {
    video_ = std::make_unique<VideoReader>(path);
  }
}

const Image& Background::Next() {
  Image frame;
  if (video_ && video_->Read(&frame)) image_ = Resized(frame, width_, height_);
  return image_;
}

void Composite(std::span<const float> image, std::span<const float> alpha, int width, int height, int x, int y,
               Image* background) {
  const size_t area = size_t(width) * height;
  for (int row = std::max(0, -y); row < std::min(height, background->height - y); ++row) {
    for (int column = std::max(0, -x); column < std::min(width, background->width - x); ++column) {
      const size_t i = size_t(row) * width + column;
      uint8_t* to = background->pixel(x + column, y + row);
      for (int c = 0; c < 3; ++c) {
        const float value = 255 * image[area * (2 - c) + i] + (1 - alpha[i]) * static_cast<float>(to[c]);
        to[c] = static_cast<uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
      }
    }
  }
}

}  // namespace bodyloom
