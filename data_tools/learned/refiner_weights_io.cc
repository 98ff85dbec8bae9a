// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/learned/refiner_weights_io.h"

#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/data_tools/learned/weight_arrays.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kMostWeightBytes = size_t{1} << 26;
constexpr const char* kSize = "pixels_per_metre";

}  // namespace

void WriteRefinerWeights(const std::string& path, const RefinerWeights& weights) {
  std::string why;
  BODYLOOM_CHECK(weights.IsValid(&why), "refiner weights: ", why);
  NpzArrays arrays;
  for (size_t i = 0; i < kRefinerShapes.size(); ++i) {
    const std::string name = kRefinerShapes[i].name;
    arrays[name] = HalfMatrix(weights.convolutions[i].kernel);
    arrays[name + "_bias"] = FloatVector(weights.convolutions[i].bias);
  }
  arrays[kSize] = FloatVector(Eigen::VectorXf::Constant(1, static_cast<float>(weights.pixels_per_metre)));
  arrays["recipe"] = NdArray::FromString(weights.recipe);
  WriteNpz(path, arrays);
}

RefinerWeights ReadRefinerWeightsBytes(const std::string& bytes, const std::string& where) {
  const NpzArrays arrays = ReadNpzBytes(bytes, where, kMostWeightBytes);
  RefinerWeights weights;
  for (const RefinerShape& shape : kRefinerShapes) {
    const std::string name = shape.name;
    weights.convolutions.push_back({MatrixFrom(arrays, name, where), VectorFrom(arrays, name + "_bias", where)});
  }
  const Eigen::VectorXf size = VectorFrom(arrays, kSize, where);
  if (size.size() != 1) {
    throw std::runtime_error(Concatenate(where, ": ", kSize, " has ", size.size(), " numbers, expected one"));
  }
  weights.pixels_per_metre = size[0];
  weights.recipe = RecipeFrom(arrays, where);
  std::string why;
  if (!weights.IsValid(&why)) throw std::runtime_error(where + ": " + why);
  return weights;
}

RefinerWeights ReadRefinerWeights(const std::string& path) {
  return ReadRefinerWeightsBytes(ReadFileBytes(path, kMostWeightBytes), path);
}

}  // namespace bodyloom
