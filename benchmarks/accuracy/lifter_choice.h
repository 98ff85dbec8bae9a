// SPDX-License-Identifier: Apache-2.0
/// The "lifter" option of the benchmarks.
#pragma once

#include <string>

#include "bodyloom/geometry/lifter_weights.h"

namespace bodyloom {

/// "built-in", "none" (null) or a file of weights; lives as long as the program. Throws as ReadLifterWeights.
const LifterWeights* LifterOf(const std::string& name);

}  // namespace bodyloom
