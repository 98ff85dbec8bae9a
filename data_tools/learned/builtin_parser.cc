// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/learned/parser_weights_io.h"

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

}  // namespace bodyloom
