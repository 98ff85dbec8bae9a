// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/densepose_detector.h"

#include <memory>

#include "bodyloom/neural/runtime.h"

namespace bodyloom {

ChartDetector DensePoseDetector(const DensePoseDetectorOptions& options) {
  StartNeuralRuntime(options.num_threads);
  UseNeuralDevice(options.device);
  const auto network = std::make_shared<const DensePoseNetwork>(options.model, options.colours);
  return [network](const Image& picture) { return network->Detect(picture); };
}

}  // namespace bodyloom
