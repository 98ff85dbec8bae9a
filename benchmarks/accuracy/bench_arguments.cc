// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/bench_arguments.h"

#include <cstdio>
#include <exception>
#include <sstream>
#include <utility>

#include "geometry/base/check.h"
#include "tests/support/paths.h"

namespace bodyloom {
namespace {

/// A line for each option: its name and its default.
std::string Usage(const std::map<std::string, std::string>& known) {
  if (known.empty()) return "it takes no options\n";
  std::string lines = "options and what they are unless stated otherwise (lists: commas)\n";
  for (const auto& [name, value] : known) {
    lines += "  --" + name + std::string(name.size() < 18 ? 18 - name.size() : 0, ' ') + " " +
             (value.empty() ? "none" : value) + "\n";
  }
  return lines;
}

}  // namespace

BenchArguments::BenchArguments(int argc, char** argv, std::map<std::string, std::string> known)
    : values_(std::move(known)) {
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    BODYLOOM_CHECK(name.starts_with("--") && values_.contains(name.substr(2)), "unknown option '", name,
                   "', expected one of those that --help lists");
    BODYLOOM_CHECK(i + 1 < argc, "option '", name, "' needs a value");
    values_[name.substr(2)] = argv[i + 1];
  }
}

int BenchArguments::Integer(const std::string& name) const {
  const std::string& text = Text(name);
  size_t used = 0;
  int value = 0;
  try {
    value = std::stoi(text, &used);
  } catch (const std::logic_error&) {
    used = 0;
  }
  BODYLOOM_CHECK(used > 0 && used == text.size(), "--", name, " is '", text, "', expected a whole number");
  return value;
}

std::vector<std::string> BenchArguments::List(const std::string& name) const {
  std::vector<std::string> items;
  std::istringstream stream(Text(name));
  for (std::string item; std::getline(stream, item, ',');) {
    if (!item.empty()) items.push_back(item);
  }
  return items;
}

std::string SharedMotions() { return SharedDir() + "/data/motion," + SharedDir() + "/data/aistpp/motions"; }

int BenchMain(const std::string& program, int argc, char** argv, std::map<std::string, std::string> known,
              const std::function<void(const BenchArguments& arguments, const std::string& command)>& run) {
  try {
    if (argc > 1 && (std::string(argv[1]) == "--help" || std::string(argv[1]) == "-h")) {
      std::printf("usage: %s%s\n\n%s", program.c_str(), known.empty() ? "" : " [--OPTION VALUE]...",
                  Usage(known).c_str());
      return 0;
    }
    std::string command = program;
    for (int i = 1; i < argc; ++i) command += " " + std::string(argv[i]);
    run(BenchArguments(argc, argv, std::move(known)), command);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program.c_str(), error.what());
    return 1;
  }
}

}  // namespace bodyloom
