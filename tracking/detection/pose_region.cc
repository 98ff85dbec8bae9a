// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/pose_region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/base/check.h"
#include "render/image/image_mat.h"

namespace bodyloom {
namespace {

/// Sides of the square beyond the body's circle, so that a person who moves stays inside until the next frame.
constexpr double kMargin = 1.25;

}  // namespace

Eigen::Vector2d PoseRegion::ImageFromFraction(const Eigen::Vector2d& fraction) const {
  return centre + Eigen::Rotation2Dd(rotation) * ((fraction - Eigen::Vector2d(0.5, 0.5)) * side);
}

Eigen::Vector2d PoseRegion::FractionFromImage(const Eigen::Vector2d& pixel) const {
  return Eigen::Rotation2Dd(-rotation) * (pixel - centre) / side + Eigen::Vector2d(0.5, 0.5);
}

bool PoseRegion::IsValid() const {
  return centre.allFinite() && std::isfinite(side) && side >= 1 && std::isfinite(rotation);
}

PoseRegion RegionAroundBody(const Eigen::Vector2d& hips, const Eigen::Vector2d& rim) {
  const Eigen::Vector2d up = rim - hips;
  const double angle = std::numbers::pi / 2 - std::atan2(-up.y(), up.x());
  const double turn = 2 * std::numbers::pi;
  return {.centre = hips,
          .side = kMargin * 2 * up.norm(),
          .rotation = angle - turn * std::floor((angle + std::numbers::pi) / turn)};
}

PoseRegion WholeImageRegion(int width, int height) {
  return {.centre = {0.5 * width, 0.5 * height}, .side = double(std::max(width, height))};
}

std::vector<PoseRegion> TileRegions(int width, int height, int level) {
  if (level <= 1) {
    return level == 1 ? std::vector{WholeImageRegion(width, height)} : std::vector<PoseRegion>();
  }
  const double side = double(std::max(width, height)) / level;
  // Starts half a side apart, the last one at the far edge; along a short side the one square is centred.
  const auto starts = [side](double length) {
    if (length <= side) return std::vector<double>{(length - side) / 2};
    std::vector<double> result;
    const int count = int(std::ceil((length - side) / (side / 2) - 1e-9)) + 1;
    result.reserve(size_t(count));
    for (int i = 0; i < count; ++i) result.push_back((length - side) * i / (count - 1));
    return result;
  };
  std::vector<PoseRegion> result;
  for (const double y : starts(height)) {
    for (const double x : starts(width)) {
      result.push_back({.centre = {x + side / 2, y + side / 2}, .side = side});
    }
  }
  return result;
}

std::vector<float> CropRegion(const Image& image, const PoseRegion& region, int size, float scale, float offset) {
  BODYLOOM_CHECK(!image.empty(), "a crop needs an image");
  BODYLOOM_CHECK(region.IsValid(), "a crop needs a region of at least a pixel, got side ", region.side);
  BODYLOOM_CHECK(size >= 1, "a crop has at least a pixel, got size ", size);
  // From column and row of the crop to the image.
  const Eigen::Vector2d origin = region.ImageFromFraction({0, 0});
  const double step = region.side / size, c = step * std::cos(region.rotation), s = step * std::sin(region.rotation);
  const cv::Matx23d image_from_crop(c, -s, origin.x(), s, c, origin.y());
  cv::Mat crop;
  cv::warpAffine(MatOf(image), crop, image_from_crop, {size, size}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                 cv::BORDER_CONSTANT, cv::Scalar::all(0));
  std::vector<float> result(size_t(size) * size * 3);
  float* to = result.data();
  for (int row = 0; row < size; ++row) {
    const uint8_t* from = crop.ptr<uint8_t>(row);
    for (int column = 0; column < size; ++column, from += 3, to += 3) {
      for (int channel = 0; channel < 3; ++channel) to[channel] = scale * float(from[2 - channel]) + offset;
    }
  }
  return result;
}

}  // namespace bodyloom
