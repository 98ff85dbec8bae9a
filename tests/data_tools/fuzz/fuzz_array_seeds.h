// SPDX-License-Identifier: Apache-2.0
/// Small valid files as seeds of the fuzzers of fuzz_array_targets.h and fuzz_file_targets.h.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bodyloom::fuzz {

/// Requires the seeds of "detections", "bvh", "deepmimic" and "track" (fuzz_text_seeds.h, fuzz_seeds.cc), which are
/// also seeds of the readers that detect the format.
void AddArraySeeds(std::map<std::string, std::vector<std::string>>* seeds);

}  // namespace bodyloom::fuzz
