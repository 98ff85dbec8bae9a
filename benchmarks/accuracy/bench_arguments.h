// SPDX-License-Identifier: Apache-2.0
/// Parses command lines of the benchmarks: "--name value" pairs, lists separated by commas.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace bodyloom {

class BenchArguments {
 public:
  /// `known` maps each option to its default. Throws std::invalid_argument for anything else, naming it.
  BenchArguments(int argc, char** argv, std::map<std::string, std::string> known);

  [[nodiscard]] const std::string& Text(const std::string& name) const { return values_.at(name); }
  [[nodiscard]] int Integer(const std::string& name) const;
  [[nodiscard]] std::vector<std::string> List(const std::string& name) const;

 private:
  std::map<std::string, std::string> values_;
};

/// Default of a "motions" option: the folders of recorded motion below SharedDir().
std::string SharedMotions();

/// main() of a benchmark: runs it with its arguments and its command line. --help lists the options. Exit code 1, with
/// one line on stderr, for any exception.
int BenchMain(const std::string& program, int argc, char** argv, std::map<std::string, std::string> known,
              const std::function<void(const BenchArguments& arguments, const std::string& command)>& run);

}  // namespace bodyloom
