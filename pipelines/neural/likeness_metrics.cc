// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/likeness_metrics.h"

#include <cmath>
#include <limits>
#include <memory>

#include "bodyloom/neural/metrics/lpips.h"
#include "bodyloom/neural/runtime.h"
#include "bodyloom/pipelines/neural/weights_folder.h"

namespace bodyloom {

std::vector<FrameMetric> LikenessMetrics(const std::string& weights_folder) {
  // Frames are compared by several threads already.
  StartNeuralRuntime(1);
  const auto lpips = std::make_shared<Lpips>();
  const WeightsFolder weights = ReadWeightsFolder(weights_folder);
  if (weights.has_lpips()) {
    lpips->Load(weights.alexnet.weights, weights.alexnet.source, weights.lpips_heads.weights,
                weights.lpips_heads.source);
  }
  const std::string network = lpips->has_random_features() ? "random_features" : "alex";
  const std::string of =
      lpips->has_random_features() ? " of a random-feature substitute: compares with nothing but itself" : "";
  FrameMetric metric;
  metric.columns = {{"lpips_" + network, "LPIPS v0.1" + of},
                    {"tlpips_" + network, "|LPIPS of the result's change - LPIPS of the truth's|" + of}};
  metric.compute = [lpips](const FramePair& frame, const FramePair* before) {
    const LpipsFeatures truth = lpips->Features(frame.truth), result = lpips->Features(frame.result);
    double change = std::numeric_limits<double>::quiet_NaN();
    if (before != nullptr) {
      change = std::abs(lpips->Distance(result, lpips->Features(before->result)).value -
                        lpips->Distance(truth, lpips->Features(before->truth)).value);
    }
    return std::vector<double>{lpips->Distance(result, truth).value, change};
  };
  return {metric};
}

}  // namespace bodyloom
