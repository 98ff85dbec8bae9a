// SPDX-License-Identifier: Apache-2.0
/// write_seeds DIR: writes DIR/npz/0, DIR/npz/1, …, DIR/pickle/0, … as seeds for the fuzzers.
#include <cstdio>
#include <exception>
#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "tests/data_tools/fuzz/fuzz_seeds.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_seeds DIR\n");
    return 2;
  }
  try {
    for (const auto& [name, seeds] : bodyloom::fuzz::Seeds()) {
      const std::filesystem::path folder = std::filesystem::path(argv[1]) / name;
      std::filesystem::create_directories(folder);
      for (size_t i = 0; i < seeds.size(); ++i) {
        bodyloom::WriteFileAtomically((folder / std::to_string(i)).string(), seeds[i]);
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
