// SPDX-License-Identifier: Apache-2.0
/// `--weights DIR`: trained weights that this project cannot ship, under fixed names.
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

/// Empty where the folder has no such file. Shapes are checked by the networks, whose messages name the file.
struct WeightsFolder {
  WeightsFrom vgg16, vgg19, alexnet, lpips_heads, sphereface;
};

/// `folder` empty: everything empty. Throws std::runtime_error naming the folder when it is none or has none of these
/// files, and the file that cannot be read or holds a tensor that is no number.
WeightsFolder ReadWeightsFolder(const std::string& folder);

/// What measures how alike pictures of people are.
inline LikenessWeights LikenessWeightsOf(WeightsFolder weights) {
  return {std::move(weights.alexnet), std::move(weights.lpips_heads), std::move(weights.vgg19)};
}

/// "vgg19 vgg19.pth, sphereface not there", one line for the user.
std::string ToText(const WeightsFolder& weights);

/// SSIM of the windows that renderers draw, whole, on black: what training and animation report.
inline constexpr SsimPreset kWindowSsim = SsimPreset::kWang2004;
inline double WindowSsim(const Image& truth, const Image& result) { return Ssim(truth, result, kWindowSsim); }

// Architecture cards of a renderer's networks, which `bodyloom neural card` prints.

enum class NeuralRenderer { kMotion, kPhoto, kGuided };

/// Names, shapes, parameters and multiply-adds of all layers, a table. `profile`: "paper", "cpu" or "tiny". Throws
/// std::invalid_argument for other names.
std::string NetworkCard(NeuralRenderer renderer, const std::string& profile);

}  // namespace bodyloom
