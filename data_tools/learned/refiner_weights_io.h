// SPDX-License-Identifier: Apache-2.0
/// The picture refiner's weights as a file: one .npz with the arrays of its network (picture_unet_arrays.h),
/// `pixels_per_metre` (one number), `moves_outline` (one number, 1 where it does, else 0) and `recipe` (text).
#pragma once

#include <string>

#include "bodyloom/render/person/refiner_weights.h"

namespace bodyloom {

/// Throws std::invalid_argument for weights that are not valid.
void WriteRefinerWeights(const std::string& path, const RefinerWeights& weights);
/// Throws std::runtime_error naming the file, the array and what was expected.
RefinerWeights ReadRefinerWeights(const std::string& path);
RefinerWeights ReadRefinerWeightsBytes(const std::string& bytes, const std::string& where);

}  // namespace bodyloom
