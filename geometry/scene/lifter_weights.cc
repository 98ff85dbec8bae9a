// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/lifter_weights.h"

#include "geometry/base/check.h"

namespace bodyloom {

std::span<const int> LifterOutput::LimbPoints(int limb) {
  static constexpr std::array<int, 2> kArms[2] = {{7, 9}, {8, 10}};
  static constexpr std::array<int, 4> kLegs[2] = {{13, 15, 17, 19}, {14, 16, 18, 20}};
  BODYLOOM_CHECK(limb >= 0 && limb < kLimbs, "lifter: limb ", limb, " of ", kLimbs);
  if (limb < 2) return kArms[limb];
  return kLegs[limb - 2];
}

size_t LifterWeights::num_parameters() const {
  size_t count =
      input.size() + input_bias.size() + norm_scale.size() + norm_shift.size() + output.size() + output_bias.size();
  for (const Block& block : blocks) {
    count += block.norm_scale.size() + block.norm_shift.size() + block.dilated.size() + block.dilated_bias.size() +
             block.mix.size() + block.mix_bias.size();
  }
  return count;
}

int LifterWeights::reach() const {
  int frames = 1;
  for (const Block& block : blocks) frames += block.dilation;
  return frames;
}

bool LifterWeights::IsValid(std::string* why) const {
  const Eigen::Index C = input.rows();
  const auto check = [&](const std::string& name, const auto& array, Eigen::Index rows, Eigen::Index cols) {
    if (array.rows() != rows || array.cols() != cols) {
      *why = Concatenate(name, " is ", array.rows(), "x", array.cols(), ", expected ", rows, "x", cols);
      return false;
    }
    if (!array.allFinite()) {
      *why = name + " holds numbers that are not finite";
      return false;
    }
    return true;
  };
  if (C == 0 || input.cols() == 0 || input.cols() % 3 != 0) {
    *why = Concatenate("input is ", input.rows(), "x", input.cols(), ", expected channels x 3 inputs");
    return false;
  }
  if (!check("input", input, C, input.cols()) || !check("input_bias", input_bias, C, 1) ||
      !check("norm_scale", norm_scale, C, 1) || !check("norm_shift", norm_shift, C, 1) ||
      !check("output", output, LifterOutput::kSize, C) || !check("output_bias", output_bias, LifterOutput::kSize, 1)) {
    return false;
  }
  for (size_t b = 0; b < blocks.size(); ++b) {
    const Block& block = blocks[b];
    const std::string name = Concatenate("block", b, ".");
    if (block.dilation < 1 || block.dilation > 4096) {
      *why = Concatenate(name, "dilation is ", block.dilation, ", expected 1 to 4096");
      return false;
    }
    if (!check(name + "norm_scale", block.norm_scale, C, 1) || !check(name + "norm_shift", block.norm_shift, C, 1) ||
        !check(name + "dilated", block.dilated, C, 3 * C) || !check(name + "dilated_bias", block.dilated_bias, C, 1) ||
        !check(name + "mix", block.mix, C, C) || !check(name + "mix_bias", block.mix_bias, C, 1)) {
      return false;
    }
  }
  return true;
}

}  // namespace bodyloom
