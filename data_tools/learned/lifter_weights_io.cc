// SPDX-License-Identifier: Apache-2.0
#include "data_tools/learned/lifter_weights_io.h"

#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/npz.h"
#include "data_tools/learned/weight_arrays.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kMaxBlocks = 64;

}  // namespace

void WriteLifterWeights(const std::string& path, const LifterWeights& weights) {
  std::string why;
  BODYLOOM_CHECK(weights.IsValid(&why), "lifter weights: ", why);
  NpzArrays arrays;
  std::vector<int32_t> dilations;
  for (size_t b = 0; b < weights.blocks.size(); ++b) {
    const LifterWeights::Block& block = weights.blocks[b];
    const std::string name = "block" + std::to_string(b) + ".";
    dilations.push_back(block.dilation);
    arrays[name + "norm_scale"] = FloatVector(block.norm_scale);
    arrays[name + "norm_shift"] = FloatVector(block.norm_shift);
    arrays[name + "dilated"] = HalfMatrix(block.dilated);
    arrays[name + "dilated_bias"] = FloatVector(block.dilated_bias);
    arrays[name + "mix"] = HalfMatrix(block.mix);
    arrays[name + "mix_bias"] = FloatVector(block.mix_bias);
  }
  arrays["dilations"] = NdArray::FromInts32(dilations.data(), {static_cast<int64_t>(dilations.size())});
  arrays["input"] = HalfMatrix(weights.input);
  arrays["input_bias"] = FloatVector(weights.input_bias);
  arrays["norm_scale"] = FloatVector(weights.norm_scale);
  arrays["norm_shift"] = FloatVector(weights.norm_shift);
  arrays["output"] = HalfMatrix(weights.output);
  arrays["output_bias"] = FloatVector(weights.output_bias);
  arrays["recipe"] = NdArray::FromString(weights.recipe);
  WriteNpz(path, arrays);
}

LifterWeights ReadLifterWeightsBytes(const std::string& bytes, const std::string& where) {
  const NpzArrays arrays = ReadNpzBytes(bytes, where, size_t{1} << 28);
  const auto matrix = [&](const std::string& name) { return MatrixFrom(arrays, name, where); };
  const auto vector = [&](const std::string& name) { return VectorFrom(arrays, name, where); };
  LifterWeights weights;
  const std::vector<int64_t> dilations = WholeNumbers(RequireArray(arrays, "dilations", where), "dilations", where);
  if (dilations.size() > kMaxBlocks) {
    throw std::runtime_error(where + ": dilations names " + std::to_string(dilations.size()) +
                             " blocks, expected at most " + std::to_string(kMaxBlocks));
  }
  for (size_t b = 0; b < dilations.size(); ++b) {
    const std::string name = "block" + std::to_string(b) + ".";
    LifterWeights::Block& block = weights.blocks.emplace_back();
    block.dilation = dilations[b] < 1 || dilations[b] > 4096 ? 0 : static_cast<int>(dilations[b]);
    block.norm_scale = vector(name + "norm_scale");
    block.norm_shift = vector(name + "norm_shift");
    block.dilated = matrix(name + "dilated");
    block.dilated_bias = vector(name + "dilated_bias");
    block.mix = matrix(name + "mix");
    block.mix_bias = vector(name + "mix_bias");
  }
  weights.input = matrix("input");
  weights.input_bias = vector("input_bias");
  weights.norm_scale = vector("norm_scale");
  weights.norm_shift = vector("norm_shift");
  weights.output = matrix("output");
  weights.output_bias = vector("output_bias");
  weights.recipe = RecipeFrom(arrays, where);
  std::string why;
  if (!weights.IsValid(&why)) throw std::runtime_error(where + ": " + why);
  return weights;
}

LifterWeights ReadLifterWeights(const std::string& path) {
  return ReadLifterWeightsBytes(ReadFileBytes(path, size_t{1} << 28), path);
}

}  // namespace bodyloom

// Made by bodyloom_embed() in data_tools/CMakeLists.txt.
extern "C" {
extern const char bodyloom_lifter_begin[], bodyloom_lifter_end[];
}

namespace bodyloom {

const LifterWeights& BuiltinLifter() {
  static const LifterWeights weights = ReadLifterWeightsBytes(std::string(bodyloom_lifter_begin, bodyloom_lifter_end),
                                                              "assets/lifter/lifter.npz (built in)");
  return weights;
}

}  // namespace bodyloom
