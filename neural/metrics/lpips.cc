// SPDX-License-Identifier: Apache-2.0
#include "neural/metrics/lpips.h"

#include <torch/torch.h>
#include <algorithm>
#include <cmath>

#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "neural/base/image_tensor.h"
#include "neural/networks/load_weights.h"
#include "neural/networks/vgg.h"

namespace bodyloom {
namespace {

using torch::Tensor;

FeatureNetworkOptions TrunkOptions(const LpipsOptions& options) {
  FeatureNetworkOptions trunk;
  const bool alex = options.trunk == LpipsTrunk::kAlexNet;
  trunk.trunk = alex ? FeatureTrunk::kAlexNet : FeatureTrunk::kVgg16;
  trunk.taps = alex ? FeatureLayers(trunk.trunk, {"relu1", "relu2", "relu3", "relu4", "relu5"})
                    : FeatureLayers(trunk.trunk, {"relu1_2", "relu2_2", "relu3_3", "relu4_3", "relu5_3"});
  trunk.normalise = false;  // LPIPS has its own shift and scale
  trunk.random_features_divisor = options.random_features_divisor;
  trunk.random_features_seed = options.random_features_seed;
  return trunk;
}

}  // namespace

/// The channel weights, one tensor per tap: parameters named weight0 … weight4.
struct LpipsHeadsImpl : torch::nn::Module {
  explicit LpipsHeadsImpl(const std::vector<int64_t>& channels) {
    for (size_t k = 0; k < channels.size(); ++k) {
      weights.push_back(register_parameter("weight" + std::to_string(k), torch::ones({1, channels[k], 1, 1}),
                                           /*requires_grad=*/false));
    }
  }
  std::vector<Tensor> weights;
};
TORCH_MODULE(LpipsHeads);

struct LpipsFeatures::Impl {
  std::vector<Tensor> unit;  ///< per tap: 1×C×h×w, unit length over channels
  int64_t generation = 0;    ///< of the network's weights
};

struct Lpips::Network {
  explicit Network(const LpipsOptions& options) : trunk(TrunkOptions(options)) {
    const torch::NoGradGuard no_grad;
    std::vector<int64_t> channels;
    for (const Tensor& tap : trunk(torch::zeros({1, 3, 32, 32}))) channels.push_back(tap.size(1));
    heads = LpipsHeads(channels);
  }
  FeatureNetwork trunk;
  LpipsHeads heads{nullptr};
  int64_t generation = 0;
};

Lpips::Lpips(const LpipsOptions& options) : network_(std::make_unique<Network>(options)) {}
Lpips::~Lpips() = default;
Lpips::Lpips(Lpips&&) noexcept = default;
Lpips& Lpips::operator=(Lpips&&) noexcept = default;

void Lpips::Load(const NamedWeights& trunk, const std::string& trunk_source, const NamedWeights& heads,
                 const std::string& heads_source) {
  LoadWeightsOptions options;
  options.name_in_file = [](const std::string& own) { return "lin" + own.substr(6) + ".model.1.weight"; };
  std::vector<int64_t> channels;
  for (const Tensor& weight : network_->heads->weights) channels.push_back(weight.size(1));
  LpipsHeads loaded(channels);  // used only if the trunk fits too
  LoadWeights(heads, heads_source, loaded.get(), options);
  network_->trunk->Load(trunk, trunk_source);
  network_->heads = loaded;
  ++network_->generation;
}

bool Lpips::has_random_features() const { return network_->trunk->has_random_features; }

LpipsFeatures Lpips::Features(const Image& image) const {
  const torch::NoGradGuard no_grad;
  const Tensor shift = torch::tensor({-.030F, -.088F, -.188F}).view({1, 3, 1, 1});
  const Tensor scale = torch::tensor({.458F, .448F, .450F}).view({1, 3, 1, 1});
  auto impl = std::make_shared<LpipsFeatures::Impl>();
  impl->generation = network_->generation;
  for (const Tensor& tap : network_->trunk((ToTensor(image) * 2 - 1 - shift) / scale)) {
    impl->unit.push_back(tap / (tap.square().sum(1, true).sqrt() + 1e-10));
  }
  LpipsFeatures features;
  features.impl_ = std::move(impl);
  return features;
}

LpipsValue Lpips::Distance(const LpipsFeatures& a, const LpipsFeatures& b) const {
  const torch::NoGradGuard no_grad;
  BODYLOOM_CHECK(a.impl_ != nullptr && b.impl_ != nullptr && a.impl_->generation == network_->generation &&
                     b.impl_->generation == network_->generation,
                 "LPIPS: features of other weights, or none");
  double value = 0;
  for (size_t k = 0; k < a.impl_->unit.size(); ++k) {
    const Tensor &x = a.impl_->unit[k], &y = b.impl_->unit[k];
    BODYLOOM_CHECK(x.sizes() == y.sizes(), "LPIPS: images of different size or network (layer ", k, ": ", x.sizes(),
                   " and ", y.sizes(), ")");
    value += (network_->heads->weights[k] * (x - y).square()).sum(1).mean().item<double>();
  }
  return {value, has_random_features()};
}

LpipsValue Lpips::Distance(const Image& a, const Image& b) const {
  BODYLOOM_CHECK(a.width == b.width && a.height == b.height, "LPIPS: images of ", a.width, " x ", a.height, " and ",
                 b.width, " x ", b.height, " pixels");
  return Distance(Features(a), Features(b));
}

Lpips LpipsFrom(const WeightsFrom& alexnet, const WeightsFrom& heads) {
  Lpips lpips;
  if (!alexnet.empty() && !heads.empty()) lpips.Load(alexnet.weights, alexnet.source, heads.weights, heads.source);
  return lpips;
}

std::string LpipsName(const char* name, bool random_features) {
  return std::string(name) + (random_features ? "_random_features" : "_alex");
}

double TemporalLpipsOf(const Lpips& lpips, const LpipsFeatures& result, const LpipsFeatures& result_before,
                       const LpipsFeatures& truth, const LpipsFeatures& truth_before) {
  return std::abs(lpips.Distance(result, result_before).value - lpips.Distance(truth, truth_before).value);
}

LpipsFeatures TemporalLpips::Moved(const Seen& rendered, int x, int y) const {
  if (x == 0 && y == 0) return rendered.features;
  return lpips_.Features(ToImage(Shifted(ToTensor(rendered.image), x, y)));
}

TemporalLpips::Frame TemporalLpips::Add(const Image& result, const Image& truth, int before_x, int before_y) {
  Seen seen_result = {result, lpips_.Features(result)}, seen_truth = {truth, lpips_.Features(truth)};
  Frame frame;
  const LpipsValue distance = lpips_.Distance(seen_result.features, seen_truth.features);
  frame.lpips = distance.value;
  frame.random_features = distance.random_features;
  if (follows_) {
    frame.tlpips = TemporalLpipsOf(lpips_, seen_result.features, Moved(last_result_, before_x, before_y),
                                   seen_truth.features, Moved(last_truth_, before_x, before_y));
    sum_tlpips_ += *frame.tlpips;
    ++pairs_;
  }
  sum_lpips_ += frame.lpips;
  last_result_ = std::move(seen_result);
  last_truth_ = std::move(seen_truth);
  follows_ = true;
  ++frames_;
  return frame;
}

TemporalLpipsMean TemporalLpips::Mean() const {
  return {frames_, sum_lpips_ / std::max(1, frames_), sum_tlpips_ / std::max(1, pairs_), pairs_,
          lpips_.has_random_features()};
}

}  // namespace bodyloom
