// SPDX-License-Identifier: Apache-2.0
/// Runs a picture U-Net (render/image/parser_weights.h) on the processor, without LibTorch.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "render/image/parser_weights.h"
#include "tracking/detection/inference/graph_executor.h"

namespace bodyloom {

/// Keeps a network for each size of picture it has met. Not for use by two threads at once; runs on the thread that
/// calls. Equal planes give equal bits.
class PictureUnetRunner {
 public:
  /// Throws std::invalid_argument for weights that are not valid.
  PictureUnetRunner(PictureUnetWeights weights, PictureUnetPlanes planes);

  /// planes.in × height × width → planes.out × height × width. Throws std::invalid_argument for another size, a picture
  /// without a pixel and sides that are not multiples of kPictureUnetMultiple.
  std::vector<float> Run(int width, int height, std::span<const float> planes);

 private:
  const GraphExecutor& NetworkFor(int width, int height);

  PictureUnetWeights weights_;
  PictureUnetPlanes planes_;
  std::map<std::pair<int, int>, GraphExecutor> networks_;
};

}  // namespace bodyloom
