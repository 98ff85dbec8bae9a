// SPDX-License-Identifier: Apache-2.0
/// The clothes parser's weights as a file: one .npz with the arrays of its network (parser_weights_io.h),
/// `pixels_per_metre` (one number) and `recipe` (text).
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

// The numbers of a picture U-Net (render/image/parser_weights.h) as arrays of a .npz file: NAME (out × 9·in,
// half-precision floats, so the file rounds them to 11 bits) and NAME_bias (out) of each of PictureUnetLayers().

/// No file of such weights is larger.
inline constexpr size_t kMostPictureUnetBytes = size_t{1} << 26;

/// The weights are valid.
void PutPictureUnet(const PictureUnetWeights& weights, PictureUnetPlanes planes, NpzArrays* arrays);
/// Sizes are for the caller to check (IsValid()). Throws std::runtime_error naming the file, the array and what was
/// expected.
PictureUnetWeights PictureUnetFrom(const NpzArrays& arrays, PictureUnetPlanes planes, const std::string& where);

}  // namespace bodyloom
