// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/learned/refiner_weights_io.h"

#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/data_tools/learned/picture_unet_arrays.h"
#include "bodyloom/data_tools/learned/weight_arrays.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr const char* kSize = "pixels_per_metre";
constexpr const char* kOutline = "moves_outline";

}  // namespace

void WriteRefinerWeights(const std::string& path, const RefinerWeights& weights) {
  std::string why;
  BODYLOOM_CHECK(weights.IsValid(&why), "refiner weights: ", why);
  NpzArrays arrays;
  PutPictureUnet(weights.network, kRefinerPlanes, &arrays);
  arrays[kSize] = FloatNumber(static_cast<float>(weights.pixels_per_metre));
  arrays[kOutline] = FloatNumber(weights.moves_outline ? 1 : 0);
  arrays["recipe"] = NdArray::FromString(weights.recipe);
  WriteNpz(path, arrays);
}

RefinerWeights ReadRefinerWeightsBytes(const std::string& bytes, const std::string& where) {
  const NpzArrays arrays = ReadNpzBytes(bytes, where, kMostPictureUnetBytes);
  RefinerWeights weights;
  weights.network = PictureUnetFrom(arrays, kRefinerPlanes, where);
  weights.pixels_per_metre = NumberFrom(arrays, kSize, where);
  const float outline = NumberFrom(arrays, kOutline, where);
  if (outline != 0 && outline != 1) {
    throw std::runtime_error(Concatenate(where, ": ", kOutline, " is ", outline, ", expected 0 or 1"));
  }
  weights.moves_outline = outline == 1;
  weights.recipe = RecipeFrom(arrays, where);
  std::string why;
  if (!weights.IsValid(&why)) throw std::runtime_error(where + ": " + why);
  return weights;
}

RefinerWeights ReadRefinerWeights(const std::string& path) {
  return ReadRefinerWeightsBytes(ReadFileBytes(path, kMostPictureUnetBytes), path);
}

}  // namespace bodyloom
