// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/refined_painter.h"

#include <span>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/render/view_camera.h"

namespace bodyloom {
RefinedPainter::RefinedPainter(const PhotoPerson& person, int num_threads, PictureRefiner* refiner)
    : refiner_(refiner) {
  if (refiner == nullptr) {
    painter_.emplace(person, num_threads);
  } else {
    layers_.emplace(person, num_threads);
  }
}

void RefinedPainter::Draw(const MatrixX3d& vertices, const Camera& camera, Image* image,
                          std::vector<uint8_t>* coverage) {
  if (painter_) {
    painter_->Draw(vertices, camera, image, coverage);
    return;
  }
  BODYLOOM_CHECK(image->width == camera.width && image->height == camera.height, "refined person: the image is ",
                 image->width, "x", image->height, ", the camera ", camera.width, "x", camera.height);
  const double factor = PictureUnetScale(PixelsPerMetre(camera, vertices.col(2).mean()), refiner_->pixels_per_metre());
  const PersonLayers layers =
      factor < 1 ? layers_->DrawColours(vertices, camera, static_cast<int>(OutlineReach::kOutwards / factor) + 2)
                 : layers_->Draw(vertices, camera);
  if (layers.width == 0) return;
  const auto change = [&] {
    if (factor == 1) return refiner_->Change(layers);
    const PersonLayers small = layers_->Draw(vertices, ScaledCamera(camera, factor));
    if (small.width == 0) return std::vector<float>(4 * layers.pixels(), 0);
    return EnlargedChange(small, refiner_->Change(small), factor, layers);
  };
  const std::vector<float> person = ChangedPerson(layers, change());
  LayOver(layers, person, image, coverage == nullptr ? std::span<uint8_t>() : std::span<uint8_t>(*coverage));
}

}  // namespace bodyloom
