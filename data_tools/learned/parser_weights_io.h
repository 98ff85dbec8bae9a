// SPDX-License-Identifier: Apache-2.0
/// The clothes parser's weights as a file: one .npz with the arrays of its network (picture_unet_arrays.h),
/// `pixels_per_metre` (one number) and `recipe` (text).
#pragma once

#include <string>

#include "bodyloom/render/person/parser_weights.h"

namespace bodyloom {

/// The clothes parser that ships with the project (assets/parser/parser.npz, embedded).
const ParserWeights& BuiltinParser();

/// Throws std::invalid_argument for weights that are not valid.
void WriteParserWeights(const std::string& path, const ParserWeights& weights);
/// Throws std::runtime_error naming the file, the array and what was expected.
ParserWeights ReadParserWeights(const std::string& path);
ParserWeights ReadParserWeightsBytes(const std::string& bytes, const std::string& where);

}  // namespace bodyloom
