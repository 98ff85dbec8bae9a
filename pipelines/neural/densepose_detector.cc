// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/densepose_detector.h"

#include <limits>
#include <memory>

#include "neural/base/runtime.h"
#include "neural/metrics/lpips.h"
#include "pipelines/neural/weights_folder.h"

namespace bodyloom {

ChartDetector DensePoseDetector(const DensePoseDetectorOptions& options) {
  StartNeuralRuntime(options.num_threads);
  UseNeuralDevice(options.device);
  const auto network = std::make_shared<const DensePoseNetwork>(options.model, options.colours);
  return [network](const Image& image) { return network->Detect(image); };
}

std::vector<FrameMetric> LikenessMetrics(const std::string& weights_folder) {
  // Frames are compared by several threads already.
  StartNeuralRuntime(1);
  const WeightsFolder weights = ReadWeightsFolder(weights_folder);
  const auto lpips = std::make_shared<Lpips>(LpipsFrom(weights.alexnet, weights.lpips_heads));
  const bool random_features = lpips->has_random_features();
  const std::string of = random_features ? " of a random-feature substitute: compares with nothing but itself" : "";
  FrameMetric metric;
  metric.columns = {
      {LpipsName("lpips", random_features), "LPIPS v0.1" + of},
      {LpipsName("tlpips", random_features), "|LPIPS of the result's change - LPIPS of the truth's|" + of}};
  metric.compute = [lpips](const FramePair& frame, const FramePair* before) {
    const LpipsFeatures truth = lpips->Features(frame.truth), result = lpips->Features(frame.result);
    double change = std::numeric_limits<double>::quiet_NaN();
    if (before != nullptr) {
      change = TemporalLpipsOf(*lpips, result, lpips->Features(before->result), truth, lpips->Features(before->truth));
    }
    return std::vector<double>{lpips->Distance(result, truth).value, change};
  };
  return {metric};
}

}  // namespace bodyloom
