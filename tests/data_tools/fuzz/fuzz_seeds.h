// SPDX-License-Identifier: Apache-2.0
/// Small valid files of every kind that the fuzzers read, generated at run time.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bodyloom::fuzz {

/// Seeds by fuzzer (tests/fuzz/CMakeLists.txt). Each is accepted by the function of that name.
std::map<std::string, std::vector<std::string>> Seeds();

}  // namespace bodyloom::fuzz
