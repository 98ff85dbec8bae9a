// SPDX-License-Identifier: Apache-2.0
/// Files of the clothes parser's weights: one .npz with the arrays of its network (below), `pixels_per_metre` (one
/// number) and `recipe` (text).
#pragma once

#include <cstddef>
#include <string>

#include "data_tools/formats/npz.h"
#include "render/image/parser_weights.h"

namespace bodyloom {

/// The clothes parser that ships with the project (assets/parser/parser.npz, embedded).
const ParserWeights& BuiltinParser();

/// Throws std::invalid_argument for weights that are not valid.
void WriteParserWeights(const std::string& path, const ParserWeights& weights);
/// Throws std::runtime_error naming the file, the array and what was expected.
ParserWeights ReadParserWeights(const std::string& path);
ParserWeights ReadParserWeightsBytes(const std::string& bytes, const std::string& where);

// Weights of an image U-Net (render/image/parser_weights.h) as arrays of a .npz file: NAME (out × 9·in, half-precision
// floats, so the file rounds them to 11 bits) and NAME_bias (out) of each of ImageUnetLayers().

/// Upper bound of the size of files with such weights.
inline constexpr size_t kMaxImageUnetBytes = size_t{1} << 26;

/// The weights must be valid.
void PutImageUnet(const ImageUnetWeights& weights, ImageUnetPlanes planes, NpzArrays* arrays);
/// The caller checks the sizes (IsValid()). Throws std::runtime_error naming the file, the array and what was expected.
ImageUnetWeights ImageUnetFrom(const NpzArrays& arrays, ImageUnetPlanes planes, const std::string& where);

}  // namespace bodyloom
