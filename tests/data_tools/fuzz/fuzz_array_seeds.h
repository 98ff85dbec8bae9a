// SPDX-License-Identifier: Apache-2.0
/// Small valid files where the fuzzers of fuzz_array_targets.h and fuzz_file_targets.h start.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bodyloom::fuzz {

/// Needs those of "detections", "bvh", "deepmimic" and "track" (fuzz_text_seeds.h, fuzz_seeds.cc): the front doors
/// start from them.
void AddArraySeeds(std::map<std::string, std::vector<std::string>>* seeds);

}  // namespace bodyloom::fuzz
