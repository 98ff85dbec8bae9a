// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/people/background.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bodyloom/data_tools/video/image_file.h"

namespace bodyloom {

Image Covering(const Image& image, int width, int height) {
  const double scale = std::max(static_cast<double>(width) / image.width, static_cast<double>(height) / image.height);
  const int w = std::max(width, static_cast<int>(std::lround(image.width * scale)));
  const int h = std::max(height, static_cast<int>(std::lround(image.height * scale)));
  Image covering(width, height);
  Paste(Resized(image, w, h), (width - w) / 2, (height - h) / 2, &covering);
  return covering;
}

Background::Background(const std::string& path, int width, int height) : width_(width), height_(height) {
  if (path.empty()) {
    image_ = StudioBackdrop(width, height);
  } else if (IsImageName(path)) {
    image_ = Covering(ReadImage(path), width, height);
  } else {
    video_ = std::make_unique<VideoReader>(path);
  }
}

const Image& Background::Next() {
  Image frame;
  if (video_ && video_->Read(&frame)) image_ = Covering(frame, width_, height_);
  return image_;
}

}  // namespace bodyloom
