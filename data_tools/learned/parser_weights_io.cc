// SPDX-License-Identifier: Apache-2.0
#include "data_tools/learned/parser_weights_io.h"

#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "data_tools/learned/weight_arrays.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr const char* kPersonSize = "pixels_per_metre";

}  // namespace

void WriteParserWeights(const std::string& path, const ParserWeights& weights) {
  std::string why;
  BODYLOOM_CHECK(weights.IsValid(&why), "parser weights: ", why);
  NpzArrays arrays;
  PutImageUnet(weights.network, kParserPlanes, &arrays);
  arrays[kPersonSize] = FloatNumber(static_cast<float>(weights.pixels_per_metre));
  arrays["recipe"] = NdArray::FromString(weights.recipe);
  WriteNpz(path, arrays);
}

ParserWeights ReadParserWeightsBytes(const std::string& bytes, const std::string& where) {
  const NpzArrays arrays = ReadNpzBytes(bytes, where, kMaxImageUnetBytes);
  ParserWeights weights;
  weights.network = ImageUnetFrom(arrays, kParserPlanes, where);
  weights.pixels_per_metre = NumberFrom(arrays, kPersonSize, where);
  weights.recipe = RecipeFrom(arrays, where);
  std::string why;
  if (!weights.IsValid(&why)) throw std::runtime_error(where + ": " + why);
  return weights;
}

ParserWeights ReadParserWeights(const std::string& path) {
  return ReadParserWeightsBytes(ReadFileBytes(path, kMaxImageUnetBytes), path);
}

}  // namespace bodyloom

// Made by bodyloom_embed() in data_tools/CMakeLists.txt.
extern "C" {
extern const char bodyloom_clothes_parser_begin[], bodyloom_clothes_parser_end[];
}

namespace bodyloom {

const ParserWeights& BuiltinParser() {
  static const ParserWeights weights = ReadParserWeightsBytes(
      std::string(bodyloom_clothes_parser_begin, bodyloom_clothes_parser_end), "assets/parser/parser.npz (built in)");
  return weights;
}

namespace {

std::string BiasOf(const std::string& layer) { return layer + "_bias"; }

}  // namespace

void PutImageUnet(const ImageUnetWeights& weights, ImageUnetPlanes planes, NpzArrays* arrays) {
  const auto layers = ImageUnetLayers(planes);
  for (size_t i = 0; i < layers.size(); ++i) {
    const std::string name = layers[i].name;
    (*arrays)[name] = HalfMatrix(weights.convolutions.at(i).kernel);
    (*arrays)[BiasOf(name)] = FloatVector(weights.convolutions[i].bias);
  }
}

ImageUnetWeights ImageUnetFrom(const NpzArrays& arrays, ImageUnetPlanes planes, const std::string& where) {
  ImageUnetWeights weights;
  for (const ImageUnetLayer& layer : ImageUnetLayers(planes)) {
    const std::string name = layer.name;
    weights.convolutions.push_back({MatrixFrom(arrays, name, where), VectorFrom(arrays, BiasOf(name), where)});
  }
  return weights;
}

}  // namespace bodyloom
