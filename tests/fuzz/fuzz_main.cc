// SPDX-License-Identifier: Apache-2.0
/// One libFuzzer program: calls the function of fuzz_*targets.h that CMakeLists.txt names.
#include BODYLOOM_FUZZ_HEADER

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  bodyloom::fuzz::BODYLOOM_FUZZ_FUNCTION(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
