// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/draw_person.h"

namespace bodyloom {
namespace {

constexpr int kSamples = 3;  ///< a pixel along x and y

}  // namespace

PersonPainter::PersonPainter(const PhotoPerson& person, int num_threads)
    : person_(&person), texels_(TexelsOf(person.texture)) {
  options_.attribute = SurfaceAttribute::kTexture;
  options_.texture = {texels_, person.texture.width, person.texture.height, 3};
  options_.samples = kSamples;
  options_.both_sides = !person.garment.empty();
  options_.num_threads = num_threads;
}

void PersonPainter::Draw(const MatrixX3d& vertices_in_camera, const Camera& camera, Image* image,
                         std::vector<uint8_t>* coverage) {
  painter_.Draw(*person_->body, vertices_in_camera, camera, options_, image, coverage);
}

}  // namespace bodyloom
