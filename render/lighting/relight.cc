// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/lighting/relight.h"

#include <algorithm>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

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
