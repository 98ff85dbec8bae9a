// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  bodyloom::fuzz::AcceptsWeights(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
