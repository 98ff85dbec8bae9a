// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>

#include "apps/verbs.h"

namespace bodyloom {

void AddVersionVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("version", "Prints the version");
  verb->callback([action] { *action = [] { std::cout << "bodyloom " << BODYLOOM_VERSION << "\n"; }; });
}

}  // namespace bodyloom
