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
