// SPDX-License-Identifier: Apache-2.0
// `bodyloom neural ...` becomes `bodyloom-neural ...`: LibTorch adds 0.4 s to the start of any program linked with it,
// so what needs it lives in an executable of its own, beside this one. `train` and `animate` have verbs of both kinds.
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/exec_beside.h"
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

struct PassedOn {
  const char *name, *what;
};

/// `train` or `animate`: a verb of verbs, most of which need LibTorch.
CLI::App* AddVerbOfVerbs(CLI::App& app, const char* name, const char* what, std::initializer_list<PassedOn> passed_on,
                         Action* action) {
  CLI::App* verb = app.add_subcommand(name, what);
  verb->require_subcommand(1);
  for (const PassedOn& other : passed_on) {
    AddPassedOnVerb(*verb, other.name, other.what, {name, other.name}, action);
  }
  return verb;
}

}  // namespace

void AddNeuralVerb(CLI::App& app, Action* action) {
  AddPassedOnVerb(app, "neural", "Runs a verb that needs LibTorch: `bodyloom neural doctor`", {}, action);
}

void AddTrainVerb(CLI::App& app, Action* action) {
  CLI::App* train = AddVerbOfVerbs(
      app, "train", "Learns a person or trains a network: `bodyloom train avatar --help`",
      {{"motion", "Trains a renderer of one person's motion-dependent appearance (needs LibTorch)"},
       {"photo", "Trains a renderer that needs one photo of a person (needs LibTorch)"},
       {"guided", "Trains a renderer that animates anybody from one photo (needs LibTorch)"},
       {"parser", "Trains the network that tells clothes, hair and skin apart (needs LibTorch)"},
       {"lifter", "Trains the network that lifts 2D joints to 3D from recorded motion (needs LibTorch)"}},
      action);
  AddTrainAvatar(*train, action);
}

void AddAnimateVerb(CLI::App& app, Action* action, std::vector<std::string> arguments) {
  CLI::App* animate = AddVerbOfVerbs(
      app, "animate", "Renders a person that was learned: `bodyloom animate avatar --help`",
      {{"motion", "Renders a person that `bodyloom train motion` learned (needs LibTorch)"},
       {"photo", "Renders a person from one photo, in any motion (needs LibTorch)"},
       {"guided", "Animates the person of a photo, as `bodyloom train guided` learned to (needs LibTorch)"}},
      action);
  AddAnimateAvatar(*animate, action);
  AddAnimatePerson(*animate, action, std::move(arguments));
}

}  // namespace bodyloom
