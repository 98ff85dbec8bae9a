// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/lifter_choice.h"

#include "bodyloom/data_tools/learned/lifter_weights_io.h"

namespace bodyloom {

const LifterWeights* LifterOf(const std::string& name) {
  if (name == "none") return nullptr;
  if (name == "built-in") return &BuiltinLifter();
  static const LifterWeights weights = ReadLifterWeights(name);
  return &weights;
}

}  // namespace bodyloom
