// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/learned/picture_unet_arrays.h"

#include "bodyloom/data_tools/learned/weight_arrays.h"

namespace bodyloom {
namespace {

std::string BiasOf(const std::string& layer) { return layer + "_bias"; }

}  // namespace

void PutPictureUnet(const PictureUnetWeights& weights, PictureUnetPlanes planes, NpzArrays* arrays) {
  const auto layers = PictureUnetLayers(planes);
  for (size_t i = 0; i < layers.size(); ++i) {
    const std::string name = layers[i].name;
    (*arrays)[name] = HalfMatrix(weights.convolutions.at(i).kernel);
    (*arrays)[BiasOf(name)] = FloatVector(weights.convolutions[i].bias);
  }
}

PictureUnetWeights PictureUnetFrom(const NpzArrays& arrays, PictureUnetPlanes planes, const std::string& where) {
  PictureUnetWeights weights;
  for (const PictureUnetLayer& layer : PictureUnetLayers(planes)) {
    const std::string name = layer.name;
    weights.convolutions.push_back({MatrixFrom(arrays, name, where), VectorFrom(arrays, BiasOf(name), where)});
  }
  return weights;
}

}  // namespace bodyloom
