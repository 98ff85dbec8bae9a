// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>

#include "apps/verbs.h"

namespace bodyloom {

void AddVersionVerb(CLI::App& app, Action* action) {
  app.set_version_flag("--version", "bodyloom " BODYLOOM_VERSION, "Print the version and exit");
  CLI::App* verb = app.add_subcommand("version", "Prints the version");
  verb->callback([action] { *action = [] { std::cout << "bodyloom " << BODYLOOM_VERSION << "\n"; }; });
}

}  // namespace bodyloom
