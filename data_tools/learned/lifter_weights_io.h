// SPDX-License-Identifier: Apache-2.0
/// Files of the lifter's weights: one .npz with arrays `input`, `input_bias`, `dilations` (B), `blockN.dilated`, …,
/// `output`, `output_bias` (geometry/scene/lifter_weights.h has their shapes) and `recipe` (text). Matrices are stored
/// as half-precision floats, so the file rounds them to 11 bits; vectors as single.
#pragma once

#include <string>

#include "geometry/scene/lifter_weights.h"

namespace bodyloom {

/// Throws std::invalid_argument for weights that are not valid.
void WriteLifterWeights(const std::string& path, const LifterWeights& weights);
/// Throws std::runtime_error naming the file, the array and what was expected.
LifterWeights ReadLifterWeights(const std::string& path);
LifterWeights ReadLifterWeightsBytes(const std::string& bytes, const std::string& where);

/// The lifter that ships with the project (assets/lifter/lifter.npz, embedded).
const LifterWeights& BuiltinLifter();

}  // namespace bodyloom
