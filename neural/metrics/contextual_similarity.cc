// SPDX-License-Identifier: Apache-2.0
#include "neural/metrics/contextual_similarity.h"

#include <torch/torch.h>

#include <cmath>

#include "neural/base/image_tensor.h"
#include "neural/losses/contextual_loss.h"
#include "neural/networks/vgg.h"

namespace bodyloom {

struct ContextualMetric::Network {
  FeatureNetwork vgg{nullptr};
};

ContextualMetric::ContextualMetric(int random_features_divisor, uint64_t random_features_seed)
    : network_(std::make_unique<Network>()) {
  FeatureNetworkOptions options;
  options.trunk = FeatureTrunk::kVgg19;
  options.taps = FeatureLayers(options.trunk, {"relu3_2", "relu4_2"});
  options.normalise = false;
  options.random_features_divisor = random_features_divisor;
  options.random_features_seed = random_features_seed;
  network_->vgg = FeatureNetwork(options);
}

ContextualMetric::~ContextualMetric() = default;
ContextualMetric::ContextualMetric(ContextualMetric&&) noexcept = default;
ContextualMetric& ContextualMetric::operator=(ContextualMetric&&) noexcept = default;

void ContextualMetric::Load(const NamedWeights& vgg19, const std::string& source) {
  network_->vgg->Load(vgg19, source);
}

ContextualValue ContextualMetric::operator()(const Image& image, const Image& target) const {
  const torch::NoGradGuard no_grad;
  const auto features = network_->vgg(ToTensor(image)), wanted = network_->vgg(ToTensor(target));
  ContextualOptions options;
  options.bandwidth = 0.1;
  options.max_points = 0;
  ContextualValue value;
  for (size_t i = 0; i < features.size(); ++i) {
    const double similarity = ContextualSimilarity(features[i], wanted[i], options)[0].item<double>();
    value.similarity += similarity;
    value.distance -= std::log(similarity);
  }
  value.random_features = network_->vgg->has_random_features;
  return value;
}

}  // namespace bodyloom
