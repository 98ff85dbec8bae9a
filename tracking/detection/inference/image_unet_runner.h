// SPDX-License-Identifier: Apache-2.0
/// Runs an image U-Net (render/image/parser_weights.h) on the processor, without LibTorch.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "render/image/parser_weights.h"
#include "tracking/detection/inference/graph_executor.h"

namespace bodyloom {

/// Caches a network for each image size it has run. Not for use by two threads at once; runs on the calling thread.
/// Equal planes give equal bits.
class ImageUnetRunner {
 public:
  /// Throws std::invalid_argument for weights that are not valid.
  ImageUnetRunner(ImageUnetWeights weights, ImageUnetPlanes planes);

  /// planes.in × height × width → planes.out × height × width. Throws std::invalid_argument for another size, an empty
  /// image and sides that are not multiples of kImageUnetMultiple.
  std::vector<float> Run(int width, int height, std::span<const float> planes);

 private:
  const GraphExecutor& NetworkFor(int width, int height);

  ImageUnetWeights weights_;
  ImageUnetPlanes planes_;
  std::map<std::pair<int, int>, GraphExecutor> networks_;
};

}  // namespace bodyloom
