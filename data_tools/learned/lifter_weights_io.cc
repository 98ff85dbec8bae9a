// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/learned/lifter_weights_io.h"

#include <cstring>
#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/data_tools/formats/whole_numbers.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kMostBlocks = 64;

NdArray HalfMatrix(const RowMatrixXf& matrix) {
  NdArray array;
  array.dtype = DType::kF16;
  array.shape = {matrix.rows(), matrix.cols()};
  array.item_size = 2;
  array.bytes.resize(2 * size_t(matrix.size()));
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    const uint16_t bits = Eigen::half(matrix.data()[i]).x;
    std::memcpy(&array.bytes[2 * size_t(i)], &bits, 2);
  }
  return array;
}

NdArray Vector(const Eigen::VectorXf& vector) { return NdArray::FromFloats(vector.data(), {vector.size()}); }

/// Reads arrays of one archive; sizes against each other are LifterWeights::IsValid's business.
class WeightsReader {
 public:
  WeightsReader(const NpzArrays& arrays, const std::string& where) : arrays_(arrays), where_(where) {}

  [[nodiscard]] const NdArray& Floats(const std::string& name, size_t dimensions) const {
    const NdArray& array = RequireArray(arrays_, name, where_);
    const bool is_float = array.dtype == DType::kF16 || array.dtype == DType::kF32 || array.dtype == DType::kF64;
    if (!is_float || array.shape.size() != dimensions || array.num_elements() == 0) {
      throw std::runtime_error(where_ + ": " + name + " is " + array.ShapeText() +
                               ", expected floating point numbers, " +
                               (dimensions == 2 ? "rows x columns" : "one row"));
    }
    return array;
  }
  [[nodiscard]] RowMatrixXf Matrix(const std::string& name) const {
    const NdArray& array = Floats(name, 2);
    const std::vector<float> values = array.ToFloats();
    return Eigen::Map<const RowMatrixXf>(values.data(), array.shape[0], array.shape[1]);
  }
  [[nodiscard]] Eigen::VectorXf Vector(const std::string& name) const {
    const std::vector<float> values = Floats(name, 1).ToFloats();
    return Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

 private:
  const NpzArrays& arrays_;
  const std::string& where_;
};

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
    arrays[name + "norm_scale"] = Vector(block.norm_scale);
    arrays[name + "norm_shift"] = Vector(block.norm_shift);
    arrays[name + "dilated"] = HalfMatrix(block.dilated);
    arrays[name + "dilated_bias"] = Vector(block.dilated_bias);
    arrays[name + "mix"] = HalfMatrix(block.mix);
    arrays[name + "mix_bias"] = Vector(block.mix_bias);
  }
  arrays["dilations"] = NdArray::FromInts32(dilations.data(), {static_cast<int64_t>(dilations.size())});
  arrays["input"] = HalfMatrix(weights.input);
  arrays["input_bias"] = Vector(weights.input_bias);
  arrays["norm_scale"] = Vector(weights.norm_scale);
  arrays["norm_shift"] = Vector(weights.norm_shift);
  arrays["output"] = HalfMatrix(weights.output);
  arrays["output_bias"] = Vector(weights.output_bias);
  arrays["recipe"] = NdArray::FromString(weights.recipe);
  WriteNpz(path, arrays);
}

LifterWeights ReadLifterWeightsBytes(const std::string& bytes, const std::string& where) {
  const NpzArrays arrays = ReadNpzBytes(bytes, where, size_t{1} << 28);
  const WeightsReader reader(arrays, where);
  LifterWeights weights;
  const std::vector<int64_t> dilations = WholeNumbers(RequireArray(arrays, "dilations", where), "dilations", where);
  if (dilations.size() > kMostBlocks) {
    throw std::runtime_error(where + ": dilations names " + std::to_string(dilations.size()) +
                             " blocks, expected at most " + std::to_string(kMostBlocks));
  }
  for (size_t b = 0; b < dilations.size(); ++b) {
    const std::string name = "block" + std::to_string(b) + ".";
    LifterWeights::Block& block = weights.blocks.emplace_back();
    block.dilation = dilations[b] < 1 || dilations[b] > 4096 ? 0 : static_cast<int>(dilations[b]);
    block.norm_scale = reader.Vector(name + "norm_scale");
    block.norm_shift = reader.Vector(name + "norm_shift");
    block.dilated = reader.Matrix(name + "dilated");
    block.dilated_bias = reader.Vector(name + "dilated_bias");
    block.mix = reader.Matrix(name + "mix");
    block.mix_bias = reader.Vector(name + "mix_bias");
  }
  weights.input = reader.Matrix("input");
  weights.input_bias = reader.Vector("input_bias");
  weights.norm_scale = reader.Vector("norm_scale");
  weights.norm_shift = reader.Vector("norm_shift");
  weights.output = reader.Matrix("output");
  weights.output_bias = reader.Vector("output_bias");
  const std::vector<std::string> recipe = RequireArray(arrays, "recipe", where).ToStrings();
  if (!recipe.empty()) weights.recipe = recipe[0];
  std::string why;
  if (!weights.IsValid(&why)) throw std::runtime_error(where + ": " + why);
  return weights;
}

LifterWeights ReadLifterWeights(const std::string& path) {
  return ReadLifterWeightsBytes(ReadFileBytes(path, size_t{1} << 28), path);
}

}  // namespace bodyloom
