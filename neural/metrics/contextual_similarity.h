// SPDX-License-Identifier: Apache-2.0
/// CS: contextual similarity of an image to a target that need not be aligned with it
/// (neural/losses/contextual_loss.h), preset of Men et al., CVPR 2020 (ADGAN): VGG-19, relu3_2 and relu4_2, RGB in [0,
/// 1] without normalisation, h = 0.1, all positions, one pair at a time (the published program centres over a batch of
/// up to 48 pairs).
///
/// The published program uses the converted Caffe model of VGG (names "conv1_1.weight", …); torchvision's weights are
/// accepted too, but give other values. It sums CX over the two layers (larger is better); tables with values above 2
/// (Yoon et al., CVPR 2021) are presumably sums of −log CX (lower is better). Both are returned.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "neural/networks/named_weights.h"
#include "render/image/image.h"

namespace bodyloom {

struct ContextualValue {
  double similarity = 0;        ///< Σ CX over the two layers, at most 2
  double distance = 0;          ///< Σ −log CX, at least 0
  bool random_features = true;  ///< not comparable with other programs' figures
};

class ContextualMetric {
 public:
  /// Starts as a random-feature substitute (with 1/divisor of the channels) until Load is called.
  explicit ContextualMetric(int random_features_divisor = 1, uint64_t random_features_seed = 1);
  ~ContextualMetric();
  ContextualMetric(ContextualMetric&&) noexcept;
  ContextualMetric& operator=(ContextualMetric&&) noexcept;

  /// Throws std::runtime_error naming source and tensor when one does not fit, std::invalid_argument for a divisor
  /// other than 1.
  void Load(const NamedWeights& vgg19, const std::string& source);

  /// Images of at least 8 pixels a side; the two may differ in size.
  [[nodiscard]] ContextualValue operator()(const Image& image, const Image& target) const;

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

}  // namespace bodyloom
