// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/weights_folder.h"

#include <array>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/weights_file.h"
#include "neural/cards/network_cards.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<const char*, WeightsFrom WeightsFolder::*>, 5> kFiles = {
    {{"vgg16", &WeightsFolder::vgg16},
     {"vgg19", &WeightsFolder::vgg19},
     {"alexnet", &WeightsFolder::alexnet},
     {"lpips_alex", &WeightsFolder::lpips_heads},
     {"sphereface", &WeightsFolder::sphereface}}};

WeightsFrom ReadOne(const fs::path& folder, const char* name) {
  WeightsFrom result;
  for (const char* extension : {".safetensors", ".pth", ".pt"}) {
    const std::string path = (folder / (std::string(name) + extension)).string();
    if (!fs::exists(path)) continue;
    const WeightsFile file = ReadWeights(path, {/*widen_halves=*/true});
    for (const auto& [tensor, array] : file.tensors) {
      if (!array.is_number()) throw std::runtime_error(path + ": tensor " + tensor + ": no numbers");
      result.weights[tensor] = {array.shape, array.ToFloats()};
    }
    if (result.empty()) throw std::runtime_error(path + ": no tensors, expected the weights of " + name);
    result.source = path;
    return result;
  }
  return result;
}

}  // namespace

WeightsFolder ReadWeightsFolder(const std::string& folder) {
  WeightsFolder weights;
  if (folder.empty()) return weights;
  if (!fs::is_directory(folder)) throw std::runtime_error(folder + ": not a folder, expected one with weights");
  bool any = false;
  for (const auto& [name, place] : kFiles) {
    weights.*place = ReadOne(folder, name);
    any = any || !(weights.*place).empty();
  }
  if (!any) {
    throw std::runtime_error(folder +
                             ": none of vgg16, vgg19, alexnet, lpips_alex, sphereface (.safetensors, .pth or .pt)");
  }
  return weights;
}

std::string ToText(const WeightsFolder& weights) {
  std::string text;
  for (const auto& [name, place] : kFiles) {
    const WeightsFrom& from = weights.*place;
    text += (text.empty() ? "" : ", ") + std::string(name) + " " +
            (from.empty() ? "not there" : fs::path(from.source).filename().string());
  }
  return text;
}

std::string NetworkCard(NeuralRenderer renderer, const std::string& profile) {
  if (renderer == NeuralRenderer::kPhoto) return PhotoCard({PhotoProfileNamed(profile)});
  if (renderer == NeuralRenderer::kGuided) return GuidedCard({GuidedProfileNamed(profile)});
  MotionConfig config;
  config.profile = MotionProfileNamed(profile);
  return MotionCard(config);
}

}  // namespace bodyloom
