// SPDX-License-Identifier: Apache-2.0
/// Reads trained weights that this project cannot ship from a folder (`--weights DIR`), under fixed names:
///
///   vgg16, vgg19, alexnet   torchvision's classifiers ("features.0.weight", …)
///   lpips_alex              LPIPS' channel weights on AlexNet ("lin0.model.1.weight", …)
///   sphereface              SphereFace-20a ("conv1_1.weight", …)
/// each as NAME.safetensors, NAME.pth or NAME.pt (the first that exists). All are optional.
#pragma once

#include <string>
#include <utility>

#include "data_tools/evaluation/ssim.h"
#include "neural/metrics/person_scores.h"
#include "neural/networks/named_weights.h"

namespace bodyloom {

/// Weights of the folder, empty where a file is missing. Shapes are checked by the networks, whose messages name the
/// file.
struct WeightsFolder {
  WeightsFrom vgg16, vgg19, alexnet, lpips_heads, sphereface;
};

/// Reads the folder; an empty path gives empty weights. Throws std::runtime_error naming the folder if it does not
/// exist or has none of these files, and naming a file that cannot be read or has a non-numeric tensor.
WeightsFolder ReadWeightsFolder(const std::string& folder);

/// Weights of the perceptual similarity metrics of images of people.
inline LikenessWeights LikenessWeightsOf(WeightsFolder weights) {
  return {std::move(weights.alexnet), std::move(weights.lpips_heads), std::move(weights.vgg19)};
}

/// Text for the user in one line: "vgg19 vgg19.pth, sphereface not there".
std::string ToText(const WeightsFolder& weights);

/// SSIM of whole rendered windows on black, as training and animation report it.
inline constexpr SsimPreset kWindowSsim = SsimPreset::kWang2004;
inline double WindowSsim(const Image& truth, const Image& result) { return Ssim(truth, result, kWindowSsim); }

// Architecture tables of a renderer's networks, printed by `bodyloom neural card`.

enum class NeuralRenderer { kMotion, kPhoto, kGuided };

/// Table of names, shapes, parameters and multiply-adds of all layers. `profile`: "paper", "cpu" or "tiny". Throws
/// std::invalid_argument for other names.
std::string NetworkCard(NeuralRenderer renderer, const std::string& profile);

}  // namespace bodyloom
