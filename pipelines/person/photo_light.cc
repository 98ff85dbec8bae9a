// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/photo_light.h"

#include <algorithm>
#include <vector>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kLightSamples = 5000;

}  // namespace

PhotoLight LightOfPhoto(const Image& picture, std::span<const uint8_t> labels, const LitSurface& surface) {
  BODYLOOM_CHECK(3 * labels.size() == picture.bgr.size(), "light of a photo: ", labels.size(), " labels for ",
                 picture.width, "x", picture.height, " pixels");
  std::vector<int> person;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const int at = y * picture.width + x;
      if (labels[at] != 0 && surface.NormalAt(x, y) != nullptr) person.push_back(at);
    }
  }
  const size_t count = std::min(person.size(), kLightSamples);
  MatrixX3d normals(static_cast<Eigen::Index>(count), 3);
  std::vector<double> light;
  std::vector<uint8_t> kinds;
  for (size_t k = 0; k < count; ++k) {
    const int at = person[k * person.size() / count], x = at % picture.width, y = at / picture.width;
    const float* n = surface.NormalAt(x, y);
    normals.row(static_cast<Eigen::Index>(k)) << n[0], n[1], n[2];
    const uint8_t* bgr = picture.pixel(x, y);
    light.push_back(LuminanceOf({DecodePixel(bgr[2] / 255.0, PixelEncoding::kSrgb),
                                 DecodePixel(bgr[1] / 255.0, PixelEncoding::kSrgb),
                                 DecodePixel(bgr[0] / 255.0, PixelEncoding::kSrgb)}));
    kinds.push_back(labels[at]);
  }
  const FitLightingResult fit =
      FitLighting(normals, light, kinds, {.max_samples = static_cast<int>(kLightSamples), .ridge = kPhotoRidge});
  PhotoLight result;
  result.fit = fit.summary;
  if (fit.summary.IsUsable() && fit.summary.mean_shading > 0) {
    result.coefficients = fit.coefficients / fit.summary.mean_shading;
  }
  return result;
}

}  // namespace bodyloom
