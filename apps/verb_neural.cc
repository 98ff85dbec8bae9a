// SPDX-License-Identifier: Apache-2.0
// `bodyloom neural ...` becomes `bodyloom-neural ...`: LibTorch adds 0.4 s to the start of any program linked with it,
// so what needs it lives in an executable of its own, beside this one.
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/exec_beside.h"
#include "apps/exec_neural.h"
#include "apps/verbs.h"

namespace bodyloom {

void ExecNeural(const std::vector<std::string>& arguments) {
  // Threads that spin between operations take the processor from whatever else runs: beside other work a network took
  // 1.6 times as long. A user's own choice stays.
  setenv("OMP_WAIT_POLICY", "passive", 0);
  ExecBeside("bodyloom-neural", arguments);
  throw std::runtime_error(ProgramBeside("bodyloom-neural").string() +
                           ": not there: the neural verbs were not built; install libtorch-dev and build again");
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
