// SPDX-License-Identifier: Apache-2.0
/// Image features of VGG-16, VGG-19 and AlexNet, for losses and metrics. Internal: includes LibTorch.
///
/// Layers are numbered as in torchvision's `features`, parameters named "features.N.weight" and "features.N.bias":
///   VGG-16 conv1_2 = 2, conv2_2 = 7, conv3_2 = 12, conv3_3 = 14, conv4_2 = 19, conv4_3 = 21, conv5_2 = 26, conv5_3 =
///   28; VGG-19 conv3_2 = 12, conv4_2 = 21, …; AlexNet conv1 … conv5 = 0, 3, 6, 8, 10; the ReLU after each is one more.
/// Sources: Simonyan & Zisserman, ICLR 2015 (configurations D and E); Krizhevsky 2014 (the one-column AlexNet).
///
/// The trained weights are not part of this project. Without them the network is a random-feature substitute:
/// convolutions whose rows (or columns, if there are fewer inputs than outputs) are orthonormal times √2, drawn from a
/// seed, biases 0. Such random features are useful to compare images, but their figures are not comparable with
/// published ones: every result is marked (has_random_features).
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <string>
#include <vector>

#include "neural/networks/load_weights.h"

namespace bodyloom {

enum class FeatureTrunk { kVgg16, kVgg19, kAlexNet };

/// torchvision's number of a layer: "conv3_2", "relu3_2" (VGG), "conv3", "relu3" (AlexNet). Throws
/// std::invalid_argument for a name that the network does not have.
int FeatureLayer(FeatureTrunk trunk, const std::string& name);
std::vector<int> FeatureLayers(FeatureTrunk trunk, const std::vector<std::string>& names);

struct FeatureNetworkOptions {
  FeatureTrunk trunk = FeatureTrunk::kVgg16;
  std::vector<int> taps;  ///< layers whose outputs are returned, ascending; layers after the last one are not built
  /// Normalises RGB in [0, 1] to (x − mean)/deviation of ImageNet: .485 .456 .406, .229 .224 .225.
  bool normalise = true;
  int random_features_divisor = 1;  ///< of the substitute's channels, for speed; trained weights need 1
  uint64_t random_features_seed = 1;
};

/// Parameters never require gradients; gradients flow to the input.
struct FeatureNetworkImpl : torch::nn::Module {
  explicit FeatureNetworkImpl(const FeatureNetworkOptions& options);
  ~FeatureNetworkImpl() override;

  /// Loads trained weights (torchvision's names, or VGG's block names "conv3_2.weight"). Weights beyond the taps (and
  /// the classifier) are reported as unused. Throws as LoadWeights, and std::invalid_argument for a divisor other than
  /// 1.
  LoadWeightsReport Load(const NamedWeights& weights, const std::string& source);

  /// B×3×H×W → one tensor per tap. Throws std::invalid_argument when the image is too small for the last tap.
  std::vector<torch::Tensor> forward(const torch::Tensor& image);

  FeatureNetworkOptions options;
  bool has_random_features = true;

 private:
  struct Layer;
  std::vector<Layer> layers_;
  torch::Tensor mean_, deviation_;  ///< of ImageNet; not buffers, which would be required in weight files
};
TORCH_MODULE(FeatureNetwork);

/// Creates the network on the networks' device (neural/base/device.h), with the named layers as taps; `weights` empty:
/// a random-feature substitute with divided channels. Throws as FeatureNetworkImpl::Load.
FeatureNetwork MakeFeatureNetwork(FeatureTrunk trunk, const std::vector<std::string>& layers,
                                  const WeightsFrom& weights, int random_features_divisor);

}  // namespace bodyloom
