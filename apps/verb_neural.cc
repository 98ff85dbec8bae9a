// SPDX-License-Identifier: Apache-2.0
// `bodyloom neural ...` becomes `bodyloom-neural ...`: LibTorch adds 0.4 s to the start of any program linked with it,
// so what needs it lives in an executable of its own, beside this one.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/exec_neural.h"
#include "apps/verbs.h"

namespace bodyloom {

void ExecNeural(const std::vector<std::string>& arguments) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "bodyloom-neural";
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  // Threads that spin between operations take the processor from whatever else runs: beside other work a network took
  // 1.6 times as long. A user's own choice stays.
  setenv("OMP_WAIT_POLICY", "passive", 0);
  execv(program.c_str(), argv.data());
  if (errno == ENOENT) {
    throw std::runtime_error(program.string() +
                             ": not there: the neural verbs were not built; install libtorch-dev and build again");
  }
  throw std::runtime_error(program.string() + ": cannot be started: " + std::strerror(errno));
}

namespace {

/// A verb whose arguments, --help too, go to the other executable, after those in `before`.
void AddPassedOnVerb(CLI::App& app, const char* name, const char* what, std::vector<std::string> before,
                     Action* action) {
  CLI::App* verb = app.add_subcommand(name, what);
  verb->prefix_command();
  verb->set_help_flag();
  verb->callback([verb, action, before = std::move(before)] {
    std::vector<std::string> arguments = before;
    const std::vector<std::string> remaining = verb->remaining();
    arguments.insert(arguments.end(), remaining.begin(), remaining.end());
    *action = [arguments] { ExecNeural(arguments); };
  });
}

}  // namespace

void AddNeuralVerb(CLI::App& app, Action* action) {
  AddPassedOnVerb(app, "neural", "Runs a verb that needs LibTorch: `bodyloom neural doctor`", {}, action);
}

void AddTrainVerb(CLI::App& app, Action* action) {
  AddPassedOnVerb(app, "train", "Trains a network: `bodyloom train motion --help`", {"train"}, action);
}

void AddAnimateVerb(CLI::App& app, Action* action) {
  AddPassedOnVerb(app, "animate", "Renders a person with a trained network: `bodyloom animate motion --help`",
                  {"animate"}, action);
}

}  // namespace bodyloom
