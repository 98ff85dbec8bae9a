// SPDX-License-Identifier: Apache-2.0
#include "render/view/person_window.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {

using Eigen::Vector2d;
using Eigen::Vector2i;

namespace {

int RoundedUp(double size, int multiple) { return static_cast<int>(std::ceil(size / multiple - 1e-9)) * multiple; }

/// Moves [corner, corner + size) by the minimum needed to contain [low, high].
int MovedToHold(int corner, int size, double low, double high) {
  if (corner + size < high) corner = static_cast<int>(std::ceil(high)) - size;
  return std::min(corner, static_cast<int>(std::floor(low)));
}

void CheckImage(const Image& image, const PersonWindow& window, int t) {
  const auto fits = [](int size, double scale, int shrunk) { return std::abs(size * scale - shrunk) < 1e-6 * shrunk; };
  BODYLOOM_CHECK(
      fits(image.width, window.scale_x, window.image_width) && fits(image.height, window.scale_y, window.image_height),
      "person window: an image of ", image.width, "x", image.height, ", planned for one of ",
      window.image_width / window.scale_x, "x", window.image_height / window.scale_y);
  BODYLOOM_CHECK(t >= 0 && t < static_cast<int>(window.corner.size()), "person window: frame ", t, " of ",
                 window.corner.size());
}

}  // namespace

PersonWindow PlanPersonWindow(const std::vector<PersonExtent>& extents, int image_width, int image_height,
                              const PersonWindowOptions& options) {
  BODYLOOM_CHECK(image_width > 0 && image_height > 0, "person window: an image of ", image_width, "x", image_height);
  BODYLOOM_CHECK(options.multiple > 0 && options.max_side >= options.multiple && options.margin >= 0,
                 "person window: max_side ", options.max_side, ", multiple ", options.multiple, ", margin ",
                 options.margin);
  // Extents are clipped to the image.
  const Vector2d last(image_width - 1, image_height - 1);
  std::vector<PersonExtent> grown;
  Vector2d largest = Vector2d::Zero();
  for (PersonExtent extent : extents) {
    if (!extent.empty()) {
      const double margin = options.margin * (extent.max - extent.min).maxCoeff();
      extent.min = (extent.min.array() - margin).max(0).min(last.array());
      extent.max = (extent.max.array() + margin).max(0).min(last.array());
      largest = largest.cwiseMax(extent.max - extent.min + Vector2d::Ones());
    }
    grown.push_back(extent);
  }
  BODYLOOM_CHECK(largest.x() > 0, "person window: the person is in none of the ", extents.size(), " frames");
  PersonWindow window;
  const int fitting_side = options.max_side / options.multiple * options.multiple;
  const double scale = options.scale > 0 ? options.scale : std::min(1.0, fitting_side / largest.maxCoeff());
  const int side = options.scale > 0 ? std::numeric_limits<int>::max() : fitting_side;
  window.image_width = std::max(1, static_cast<int>(std::lround(scale * image_width)));
  window.image_height = std::max(1, static_cast<int>(std::lround(scale * image_height)));
  window.scale_x = static_cast<double>(window.image_width) / image_width;
  window.scale_y = static_cast<double>(window.image_height) / image_height;
  window.width = std::min(side, RoundedUp(largest.x() * window.scale_x, options.multiple));
  window.height = std::min(side, RoundedUp(largest.y() * window.scale_y, options.multiple));

  bool placed = false;
  Vector2i corner(0, 0);
  for (const PersonExtent& extent : grown) {
    if (!extent.empty()) {
      // Pixel i of the image covers [i, i + 1) here.
      const Vector2d scales(window.scale_x, window.scale_y);
      const Vector2d low = extent.min.cwiseProduct(scales);
      const Vector2d high = (extent.max + Vector2d::Ones()).cwiseProduct(scales);
      const Vector2i size(window.width, window.height);
      for (int c = 0; c < 2; ++c) {
        if (!placed) corner[c] = static_cast<int>(std::lround(0.5 * (low[c] + high[c] - size[c])));
        corner[c] = MovedToHold(corner[c], size[c], low[c], high[c]);
      }
      if (!placed) std::fill(window.corner.begin(), window.corner.end(), corner);
      placed = true;
    }
    window.corner.push_back(corner);
  }
  return window;
}

Camera CameraInWindow(const Camera& camera, const PersonWindow& window, int t) {
  Camera result = camera;
  const Vector2i& corner = window.corner.at(t);
  result.width = window.width;
  result.height = window.height;
  result.fx *= window.scale_x;
  result.fy *= window.scale_y;
  result.scale *= 0.5 * (window.scale_x + window.scale_y);
  result.cx = (camera.cx + 0.5) * window.scale_x - 0.5 - corner.x();
  result.cy = (camera.cy + 0.5) * window.scale_y - 0.5 - corner.y();
  return result;
}

Image CutWindow(const Image& image, const PersonWindow& window, int t) {
  CheckImage(image, window, t);
  const Vector2i& corner = window.corner[t];
  Image cut(window.width, window.height);
  const bool same = window.image_width == image.width && window.image_height == image.height;
  Paste(same ? image : Resized(image, window.image_width, window.image_height), -corner.x(), -corner.y(), &cut);
  return cut;
}

std::vector<uint8_t> CutLabels(const Image& labels, const PersonWindow& window, int t) {
  CheckImage(labels, window, t);
  std::vector<uint8_t> cut(static_cast<size_t>(window.width) * window.height, 0);
  for (int y = 0; y < window.height; ++y) {
    const int shrunk_y = y + window.corner[t].y();
    if (shrunk_y < 0 || shrunk_y >= window.image_height) continue;
    const int from_y = std::min(labels.height - 1, static_cast<int>((shrunk_y + 0.5) / window.scale_y));
    for (int x = 0; x < window.width; ++x) {
      const int shrunk_x = x + window.corner[t].x();
      if (shrunk_x < 0 || shrunk_x >= window.image_width) continue;
      const int from_x = std::min(labels.width - 1, static_cast<int>((shrunk_x + 0.5) / window.scale_x));
      cut[static_cast<size_t>(y) * window.width + x] = labels.pixel(from_x, from_y)[0];
    }
  }
  return cut;
}

}  // namespace bodyloom
