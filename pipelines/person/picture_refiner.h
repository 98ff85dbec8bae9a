// SPDX-License-Identifier: Apache-2.0
/// Runs the picture refiner (render/person/refiner_weights.h) on the processor, without LibTorch.
#pragma once

#include <vector>

#include "bodyloom/pipelines/person/picture_unet_runner.h"
#include "bodyloom/render/person/person_layers.h"
#include "bodyloom/render/person/refiner_weights.h"

namespace bodyloom {

/// Not for use by two threads at once; runs on the thread that calls. Equal layers give equal bits.
class PictureRefiner {
 public:
  /// Throws std::invalid_argument for weights that are not valid.
  explicit PictureRefiner(RefinerWeights weights);

  /// One of the same weights, for another thread.
  [[nodiscard]] PictureRefiner Another() const;

  [[nodiscard]] double pixels_per_metre() const { return pixels_per_metre_; }

  /// What ChangedPerson() takes: 4 × height × width, alpha near the outline (KeepNearOutline()), or not at all where the
  /// weights say so. Throws std::invalid_argument for layers without a pixel.
  std::vector<float> Change(const PersonLayers& layers);

 private:
  double pixels_per_metre_;
  bool moves_outline_;
  PictureUnetRunner network_;
};

}  // namespace bodyloom
