// SPDX-License-Identifier: Apache-2.0
/// Small valid files as seeds of the fuzzers of fuzz_run_targets.h: inputs of jobs other than weights, images and
/// observations.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bodyloom::fuzz {

void AddRunSeeds(std::map<std::string, std::vector<std::string>>* seeds);

}  // namespace bodyloom::fuzz
