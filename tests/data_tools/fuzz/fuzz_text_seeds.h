// SPDX-License-Identifier: Apache-2.0
/// Small valid text files of every format as seeds of the fuzzers of fuzz_text_targets.h.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bodyloom::fuzz {

void AddTextSeeds(std::map<std::string, std::vector<std::string>>* seeds);

}  // namespace bodyloom::fuzz
