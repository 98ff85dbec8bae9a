// SPDX-License-Identifier: Apache-2.0
/// Seeds for what jobs read beside weights, pictures and observations, small and valid: where the fuzzers of
/// fuzz_run_targets.h start.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bodyloom::fuzz {

void AddRunSeeds(std::map<std::string, std::vector<std::string>>* seeds);

}  // namespace bodyloom::fuzz
