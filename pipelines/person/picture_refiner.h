// SPDX-License-Identifier: Apache-2.0
/// Runs the picture refiner (render/person/refiner_weights.h) on the processor, without LibTorch.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bodyloom/data_tools/detection/tflite_network.h"
#include "bodyloom/render/person/person_layers.h"
#include "bodyloom/render/person/refiner_weights.h"

namespace bodyloom {

/// Keeps a network for each size of layers it has met. Not for use by two threads at once; runs on the thread that calls.
/// Equal layers give equal bits.
class PictureRefiner {
 public:
  /// Throws std::invalid_argument for weights that are not valid.
  explicit PictureRefiner(RefinerWeights weights);

  [[nodiscard]] const RefinerWeights& weights() const { return weights_; }

  /// What ChangedPerson() takes, alpha near the outline (KeepNearOutline()): 4 × height × width. Throws
  /// std::invalid_argument for layers without a pixel.
  std::vector<float> Change(const PersonLayers& layers);

 private:
  TfliteNetwork& NetworkFor(int width, int height);

  RefinerWeights weights_;
  std::map<std::pair<int, int>, TfliteNetwork> networks_;
};

}  // namespace bodyloom
