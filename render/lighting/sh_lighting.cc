// SPDX-License-Identifier: Apache-2.0
#include "render/lighting/sh_lighting.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

/// A_l / π of each coefficient.
ShVector Lobes() {
  ShVector lobes;
  lobes << 1, 2 / 3.0, 2 / 3.0, 2 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25;
  return lobes;
}

}  // namespace

ShVector ShBasis(const Vector3d& n) {
  static const double k0 = 0.5 * std::sqrt(1 / M_PI), k1 = 0.5 * std::sqrt(3 / M_PI), k2 = 0.5 * std::sqrt(15 / M_PI),
                      k20 = 0.25 * std::sqrt(5 / M_PI);
  const double x = n.x(), y = n.y(), z = n.z();
  ShVector basis;
  basis << k0, k1 * y, k1 * z, k1 * x, k2 * x * y, k2 * y * z, k20 * (3 * z * z - 1), k2 * x * z,
      0.5 * k2 * (x * x - y * y);
  return basis;
}

ShLighting AmbientLight(const Vector3d& colour) {
  ShLighting lighting = ShLighting::Zero();
  lighting.col(0) = colour * std::sqrt(4 * M_PI);
  return lighting;
}

ShVector EvenLight() { return AmbientLight(Vector3d::Ones()).row(0).transpose(); }

double LuminanceOf(const Vector3d& light) { return Vector3d(0.2126, 0.7152, 0.0722).dot(light); }

ShLighting DirectionalLight(const Vector3d& towards_light, const Vector3d& colour) {
  const double length = towards_light.norm();
  BODYLOOM_CHECK(std::isfinite(length) && length > 0, "a light needs a direction");
  // Radiance π · colour · δ(towards_light): its irradiance over π is colour · max(0, n · towards_light).
  return M_PI * colour * (Lobes().cwiseProduct(ShBasis(towards_light / length))).transpose();
}

double DecodePixel(double value, PixelEncoding encoding) {
  const double v = std::clamp(value, 0.0, 1.0);
  if (encoding == PixelEncoding::kLinear) return v;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

double EncodePixel(double light, PixelEncoding encoding) {
  const double v = std::clamp(light, 0.0, 1.0);
  if (encoding == PixelEncoding::kLinear) return v;
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

ShLighting EnvironmentLight(const Image& equirectangular, PixelEncoding encoding) {
  BODYLOOM_CHECK(!equirectangular.empty(), "an environment needs pixels");
  const int width = equirectangular.width, height = equirectangular.height;
  std::array<double, 256> light;
  for (int i = 0; i < 256; ++i) light[i] = DecodePixel(i / 255.0, encoding);
  ShLighting radiance = ShLighting::Zero();
  for (int row = 0; row < height; ++row) {
    const double down = M_PI * (row + 0.5) / height;
    // Exact solid angle of the row's pixels: they sum to 4π for any image size.
    const double solid_angle = 2 * M_PI / width * (std::cos(M_PI * row / height) - std::cos(M_PI * (row + 1) / height));
    for (int column = 0; column < width; ++column) {
      const double right = 2 * M_PI * ((column + 0.5) / width - 0.5);
      const Vector3d direction(std::sin(right) * std::sin(down), -std::cos(down), std::cos(right) * std::sin(down));
      const uint8_t* bgr = equirectangular.pixel(column, row);
      radiance += solid_angle * Vector3d(light[bgr[2]], light[bgr[1]], light[bgr[0]]) * ShBasis(direction).transpose();
    }
  }
  return radiance * Lobes().asDiagonal();
}

void Relight(const ShLighting& old_light, const ShLighting& new_light, std::span<const float> normals,
             std::span<const float> alpha, const RelightOptions& options, std::span<float> image) {
  const size_t area = alpha.size();
  BODYLOOM_CHECK(normals.size() == 3 * area && image.size() == 3 * area, "relight: ", area, " pixels, ", normals.size(),
                 " values of normals and ", image.size(), " of the image, expected three a pixel");
  BODYLOOM_CHECK(options.min_shading > 0 && options.max_ratio > 0 && options.min_normal_length > 0,
                 "relight: options must be positive");
  for (size_t i = 0; i < area; ++i) {
    const double a = alpha[i];
    if (!(a >= 1 / 255.0)) continue;
    const Eigen::Vector3d n(normals[i], normals[area + i], normals[2 * area + i]);
    const double length = n.norm();
    if (!(length >= options.min_normal_length * a)) continue;
    const ShVector basis = ShBasis(n / length);
    const Eigen::Vector3d was = (old_light * basis).cwiseMax(options.min_shading);
    const Eigen::Vector3d is = (new_light * basis).cwiseMax(options.min_shading);
    for (int c = 0; c < 3; ++c) {
      float& value = image[area * c + i];
      const double light = DecodePixel(value / a, options.encoding) * std::min(is[c] / was[c], options.max_ratio);
      value = static_cast<float>(a * EncodePixel(light, options.encoding));
    }
  }
}

}  // namespace bodyloom
