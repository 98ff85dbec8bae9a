// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/learned/lifter_weights_io.h"

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
