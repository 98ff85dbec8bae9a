// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/learned/parser_weights_io.h"

#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/data_tools/learned/picture_unet_arrays.h"
#include "bodyloom/data_tools/learned/weight_arrays.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr const char* kPersonSize = "pixels_per_metre";

}  // namespace

void WriteParserWeights(const std::string& path, const ParserWeights& weights) {
  std::string why;
  BODYLOOM_CHECK(weights.IsValid(&why), "parser weights: ", why);
  NpzArrays arrays;
  PutPictureUnet(weights.network, kParserPlanes, &arrays);
  arrays[kPersonSize] = FloatNumber(static_cast<float>(weights.pixels_per_metre));
  arrays["recipe"] = NdArray::FromString(weights.recipe);
  WriteNpz(path, arrays);
}

ParserWeights ReadParserWeightsBytes(const std::string& bytes, const std::string& where) {
  const NpzArrays arrays = ReadNpzBytes(bytes, where, kMostPictureUnetBytes);
  ParserWeights weights;
  weights.network = PictureUnetFrom(arrays, kParserPlanes, where);
  weights.pixels_per_metre = NumberFrom(arrays, kPersonSize, where);
  weights.recipe = RecipeFrom(arrays, where);
  std::string why;
  if (!weights.IsValid(&why)) throw std::runtime_error(where + ": " + why);
  return weights;
}

ParserWeights ReadParserWeights(const std::string& path) {
  return ReadParserWeightsBytes(ReadFileBytes(path, kMostPictureUnetBytes), path);
}

}  // namespace bodyloom
