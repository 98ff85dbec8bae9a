// SPDX-License-Identifier: Apache-2.0
#include "render/image/lens_correction.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "geometry/base/check.h"
#include "render/image/image_mat.h"

namespace bodyloom {

LensCorrection::LensCorrection(const Camera& camera) : ideal_(camera) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole && camera.width > 0 && camera.height > 0,
                 "LensCorrection: expected a pinhole camera of a known image size");
  ideal_.distortion = {};
  constexpr float kNowhere = -10;
  const size_t count = size_t(camera.width) * size_t(camera.height);
  xs_.assign(count, kNowhere), ys_.assign(count, kNowhere);
  for (int y = 0, i = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x, ++i) {
      Eigen::Vector2d seen;
      const Eigen::Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
      if (!camera.Project(ray, &seen)) continue;
      if (!(seen.array().abs() < 1e6).all()) continue;
      xs_[size_t(i)] = float(seen.x()), ys_[size_t(i)] = float(seen.y());
    }
  }
}

Image LensCorrection::Corrected(const Image& image) const {
  BODYLOOM_CHECK(image.width == ideal_.width && image.height == ideal_.height, "LensCorrection: an image of ",
                 image.width, "x", image.height, ", expected ", ideal_.width, "x", ideal_.height);
  Image corrected(image.width, image.height);
  const auto map = [&](const std::vector<float>& values) {
    return cv::Mat(image.height, image.width, CV_32F, const_cast<float*>(values.data()));  // only read
  };
  cv::Mat to = MatOf(&corrected);
  cv::remap(MatOf(image), to, map(xs_), map(ys_), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar());
  return corrected;
}

std::optional<ImagePixel> LensCorrection::SourceOf(int x, int y) const {
  if (x < 0 || y < 0 || x >= ideal_.width || y >= ideal_.height) return std::nullopt;
  const size_t i = size_t(y) * size_t(ideal_.width) + size_t(x);
  const ImagePixel source = {int(std::lround(xs_[i])), int(std::lround(ys_[i]))};
  const bool inside = source.x >= 0 && source.y >= 0 && source.x < ideal_.width && source.y < ideal_.height;
  return inside ? std::optional(source) : std::nullopt;
}

}  // namespace bodyloom
