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

void AddNeuralVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("neural", "Runs a verb that needs LibTorch: `bodyloom neural doctor`");
  verb->footer(
      "Verbs:\n"
      "  doctor   which LibTorch, how many threads, which matrix library, and what makes it slow\n"
      "  card     what a system's networks are made of\n"
      "  train    trains a network (also: bodyloom train)\n"
      "  animate  renders a person with a trained network (also: bodyloom animate)\n"
      "  metrics  with --lpips (also: bodyloom metrics)\n");
  verb->prefix_command();  // everything after `neural` belongs to the other executable
  verb->callback([verb, action] { *action = [arguments = verb->remaining()] { ExecNeural(arguments); }; });
}

namespace {

/// A verb of this executable's own that the other one has under the same name.
void AddNeuralVerbOfItsOwn(CLI::App& app, const char* name, const char* what, const char* footer, Action* action) {
  CLI::App* verb = app.add_subcommand(name, what);
  verb->footer(footer);
  verb->prefix_command();
  verb->callback([verb, action, name] {
    std::vector<std::string> arguments = verb->remaining();
    arguments.insert(arguments.begin(), name);
    *action = [arguments] { ExecNeural(arguments); };
  });
}

}  // namespace

void AddTrainVerb(CLI::App& app, Action* action) {
  AddNeuralVerbOfItsOwn(app, "train", "Trains a network: `bodyloom train motion --help`",
                        "Networks:\n"
                        "  lifter   from 2D joints to 3D, the start of `bodyloom track`\n"
                        "  motion   how a person looks as a function of how the body has moved, from one video\n",
                        action);
}

void AddAnimateVerb(CLI::App& app, Action* action) {
  AddNeuralVerbOfItsOwn(app, "animate", "Renders a person with a trained network: `bodyloom animate motion --help`",
                        "Networks:\n"
                        "  motion   of `bodyloom train motion`\n",
                        action);
}

}  // namespace bodyloom
