// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/label_image.h"

#include <algorithm>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {

std::vector<uint8_t> LabelImage::Over(int image_width, int image_height) const {
  std::vector<uint8_t> over;
  over.reserve(size_t(image_width) * size_t(image_height));
  for (int y = 0; y < image_height; ++y) {
    for (int x = 0; x < image_width; ++x) over.push_back(At(x, y));
  }
  return over;
}

PackedLabels::PackedLabels(const LabelImage& image)
    : x_begin_(image.x_begin), y_begin_(image.y_begin), width_(image.width), height_(image.height) {
  BODYLOOM_CHECK(image.labels.size() <= std::numeric_limits<uint32_t>::max(), "labels: ", image.labels.size(),
                 " pixels in one image");
  for (auto from = image.labels.begin(); from != image.labels.end();) {
    const uint8_t label = *from;
    from = std::find_if(from, image.labels.end(), [label](uint8_t other) { return other != label; });
    ends_.push_back(static_cast<uint32_t>(from - image.labels.begin()));
    labels_.push_back(label);
  }
  ends_.shrink_to_fit();
  labels_.shrink_to_fit();
}

LabelImage PackedLabels::Unpacked() const {
  LabelImage image{x_begin_, y_begin_, width_, height_, {}};
  image.labels.reserve(ends_.empty() ? 0 : ends_.back());
  for (size_t i = 0; i < ends_.size(); ++i) image.labels.resize(ends_[i], labels_[i]);
  return image;
}

uint8_t PackedLabels::At(int x, int y) const {
  if (x < x_begin_ || y < y_begin_ || x >= x_begin_ + width_ || y >= y_begin_ + height_) return 0;
  const size_t pixel = size_t(y - y_begin_) * size_t(width_) + size_t(x - x_begin_);
  const auto end = std::upper_bound(ends_.begin(), ends_.end(), pixel);
  return end == ends_.end() ? 0 : labels_[size_t(end - ends_.begin())];
}

}  // namespace bodyloom
