// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/vgg.h"

#include <ATen/CPUGeneratorImpl.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "neural/base/device.h"

namespace bodyloom {

enum class FeatureLayerKind { kConv, kRelu, kPool };

/// A layer of torchvision's `features`, named as in FeatureLayer; empty name for pools.
struct FeatureLayerPlan {
  FeatureLayerKind kind;
  std::string name;
  int channels = 0, kernel = 3, stride = 1, padding = 1;
};

namespace {

std::vector<FeatureLayerPlan> VggPlan(const std::vector<int>& convolutions_of_block) {
  std::vector<FeatureLayerPlan> plan;
  for (size_t b = 0; b < convolutions_of_block.size(); ++b) {
    for (int i = 0; i < convolutions_of_block[b]; ++i) {
      const std::string name = std::to_string(b + 1) + "_" + std::to_string(i + 1);
      plan.push_back({FeatureLayerKind::kConv, "conv" + name, std::min(64 << b, 512)});
      plan.push_back({FeatureLayerKind::kRelu, "relu" + name});
    }
    plan.push_back({FeatureLayerKind::kPool, "", 0, 2, 2, 0});
  }
  return plan;
}

std::vector<FeatureLayerPlan> AlexNetPlan() {
  const FeatureLayerPlan pool = {FeatureLayerKind::kPool, "", 0, 3, 2, 0};
  return {{FeatureLayerKind::kConv, "conv1", 64, 11, 4, 2},
          {FeatureLayerKind::kRelu, "relu1"},
          pool,
          {FeatureLayerKind::kConv, "conv2", 192, 5, 1, 2},
          {FeatureLayerKind::kRelu, "relu2"},
          pool,
          {FeatureLayerKind::kConv, "conv3", 384},
          {FeatureLayerKind::kRelu, "relu3"},
          {FeatureLayerKind::kConv, "conv4", 256},
          {FeatureLayerKind::kRelu, "relu4"},
          {FeatureLayerKind::kConv, "conv5", 256},
          {FeatureLayerKind::kRelu, "relu5"},
          pool};
}

const std::vector<FeatureLayerPlan>& PlanOf(FeatureTrunk trunk) {
  static const std::vector<FeatureLayerPlan> kVgg16 = VggPlan({2, 2, 3, 3, 3}), kVgg19 = VggPlan({2, 2, 4, 4, 4}),
                                             kAlexNet = AlexNetPlan();
  return trunk == FeatureTrunk::kVgg16 ? kVgg16 : trunk == FeatureTrunk::kVgg19 ? kVgg19 : kAlexNet;
}

/// out×in×k×k with orthonormal rows (or columns) times √2, preserving the magnitude of activations through a ReLU: A
/// random and A Aᵀ = L Lᵀ give L⁻¹ A (a third of the time of a QR decomposition, and A is well conditioned).
torch::Tensor OrthogonalWeight(torch::IntArrayRef shape, torch::Generator generator) {
  const int64_t rows = shape[0], columns = c10::multiply_integers(shape) / rows;
  const bool wide = columns >= rows;
  const torch::Tensor random =
      torch::randn({std::min(rows, columns), std::max(rows, columns)}, std::move(generator), torch::kDouble);
  const torch::Tensor lower = torch::linalg_cholesky(torch::mm(random, random.t()));
  const torch::Tensor matrix = std::sqrt(2.0) * torch::linalg_solve_triangular(lower, random, /*upper=*/false);
  return (wide ? matrix : matrix.t()).reshape(shape).to(torch::kFloat);
}

}  // namespace

struct FeatureNetworkImpl::Layer {
  FeatureLayerPlan plan;
  torch::nn::Conv2d conv{nullptr};
};

int FeatureLayer(FeatureTrunk trunk, const std::string& name) {
  const std::vector<FeatureLayerPlan>& plan = PlanOf(trunk);
  const auto found = std::find_if(plan.begin(), plan.end(), [&](const FeatureLayerPlan& l) { return l.name == name; });
  BODYLOOM_CHECK(!name.empty() && found != plan.end(), "feature network: no layer \"", name, "\", expected one like \"",
                 plan.front().name, "\" or \"", plan[1].name, "\"");
  return static_cast<int>(found - plan.begin());
}

std::vector<int> FeatureLayers(FeatureTrunk trunk, const std::vector<std::string>& names) {
  std::vector<int> layers;
  layers.reserve(names.size());
  for (const std::string& name : names) layers.push_back(FeatureLayer(trunk, name));
  return layers;
}

FeatureNetworkImpl::FeatureNetworkImpl(const FeatureNetworkOptions& network_options) : options(network_options) {
  const std::vector<FeatureLayerPlan>& plan = PlanOf(options.trunk);
  BODYLOOM_CHECK(!options.taps.empty() && std::is_sorted(options.taps.begin(), options.taps.end()) &&
                     options.taps.front() >= 0 && options.taps.back() < static_cast<int>(plan.size()),
                 "feature network: ", options.taps.size(), " taps, expected one or more, ascending, from 0 to ",
                 plan.size() - 1);
  BODYLOOM_CHECK(options.random_features_divisor >= 1 && options.random_features_divisor <= 32,
                 "feature network: divisor ", options.random_features_divisor, ", expected 1 to 32");
  const torch::Generator generator = at::make_generator<at::CPUGeneratorImpl>(options.random_features_seed);
  torch::nn::Sequential features;
  int channels = 3;
  for (int i = 0; i <= options.taps.back(); ++i) {
    layers_.push_back({plan[i]});
    if (plan[i].kind != FeatureLayerKind::kConv) continue;
    const int to = plan[i].channels / options.random_features_divisor;
    torch::nn::Conv2d conv(
        torch::nn::Conv2dOptions(channels, to, plan[i].kernel).stride(plan[i].stride).padding(plan[i].padding));
    const torch::NoGradGuard no_grad;
    conv->weight.copy_(OrthogonalWeight(conv->weight.sizes(), generator));
    conv->bias.zero_();
    features->push_back(std::to_string(i), conv);
    layers_.back().conv = conv;
    channels = to;
  }
  register_module("features", features);
  for (torch::Tensor& p : parameters()) p.requires_grad_(false);
  mean_ = torch::tensor({0.485, 0.456, 0.406}).view({1, 3, 1, 1});
  deviation_ = torch::tensor({0.229, 0.224, 0.225}).view({1, 3, 1, 1});
}

FeatureNetworkImpl::~FeatureNetworkImpl() = default;

LoadWeightsReport FeatureNetworkImpl::Load(const NamedWeights& weights, const std::string& source) {
  BODYLOOM_CHECK(options.random_features_divisor == 1, "feature network: trained weights for a network of 1/",
                 options.random_features_divisor, " of the channels");
  LoadWeightsOptions load;
  if (weights.count("features.0.weight") == 0 && weights.count(layers_.front().plan.name + ".weight") != 0) {
    load.name_in_file = [this](const std::string& own) {  // "features.12.weight" → "conv3_2.weight"
      const size_t number = own.find('.') + 1, field = own.rfind('.');
      return layers_.at(std::stoi(own.substr(number, field - number))).plan.name + own.substr(field);
    };
  }
  LoadWeightsReport report = LoadWeights(weights, source, this, load);
  has_random_features = false;
  return report;
}

std::vector<torch::Tensor> FeatureNetworkImpl::forward(const torch::Tensor& image) {
  BODYLOOM_CHECK(image.dim() == 4 && image.size(1) == 3, "feature network: an image of shape ", image.sizes(),
                 ", expected B x 3 x H x W");
  int64_t side = std::min(image.size(2), image.size(3));
  for (const Layer& layer : layers_) {
    if (layer.plan.kind == FeatureLayerKind::kRelu) continue;
    const int64_t reach = side + 2 * layer.plan.padding - layer.plan.kernel;
    side = reach < 0 ? 0 : reach / layer.plan.stride + 1;
    BODYLOOM_CHECK(side > 0, "feature network: an image of ", image.size(2), " x ", image.size(3),
                   " pixels is too small for its last tap");
  }
  torch::Tensor x = image;
  if (options.normalise) x = (x - mean_.to(x.options())) / deviation_.to(x.options());
  std::vector<torch::Tensor> features;
  size_t tap = 0;
  for (int i = 0; i < static_cast<int>(layers_.size()); ++i) {
    Layer& layer = layers_[i];
    if (layer.plan.kind == FeatureLayerKind::kConv) {
      x = layer.conv(x);
    } else if (layer.plan.kind == FeatureLayerKind::kPool) {
      x = torch::max_pool2d(x, layer.plan.kernel, layer.plan.stride);
    } else if (tap > 0 && options.taps[tap - 1] == i - 1) {
      x = torch::relu(x);  // the value before the ReLU is a tap
    } else {
      x = torch::relu_(x);
    }
    for (; tap < options.taps.size() && options.taps[tap] == i; ++tap) features.push_back(x);
  }
  return features;
}

FeatureNetwork MakeFeatureNetwork(FeatureTrunk trunk, const std::vector<std::string>& layers,
                                  const WeightsFrom& weights, int random_features_divisor) {
  FeatureNetworkOptions options;
  options.trunk = trunk;
  options.taps = FeatureLayers(trunk, layers);
  if (weights.empty()) options.random_features_divisor = random_features_divisor;
  FeatureNetwork network(options);
  if (!weights.empty()) network->Load(weights.weights, weights.source);
  network->to(NeuralDevice());
  return network;
}

}  // namespace bodyloom
