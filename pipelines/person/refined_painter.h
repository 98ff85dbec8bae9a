// SPDX-License-Identifier: Apache-2.0
/// Pictures of a person made from photos, refined by a network where there is one.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bodyloom/pipelines/person/draw_person.h"
#include "bodyloom/pipelines/person/person_layer_painter.h"
#include "bodyloom/pipelines/person/picture_refiner.h"

namespace bodyloom {

/// Keeps its memory between pictures. Not for use by two threads at once.
class RefinedPainter {
 public:
  /// `person` and `refiner` must outlive this; null: the person as PersonPainter draws it.
  RefinedPainter(const PhotoPerson& person, int num_threads, PictureRefiner* refiner);

  /// As PersonPainter::Draw. Where the person is more than a quarter larger than those that the refiner learned from, the
  /// change is found in a smaller picture, as large as they were, and enlarged: the network knows no other size, and a
  /// picture of nine times the pixels costs little more.
  void Draw(const MatrixX3d& vertices_in_camera, const Camera& camera, Image* image,
            std::vector<uint8_t>* coverage = nullptr);

 private:
  PictureRefiner* refiner_;
  std::optional<PersonPainter> painter_;
  std::optional<PersonLayerPainter> layers_;
};

}  // namespace bodyloom
