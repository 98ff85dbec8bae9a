// SPDX-License-Identifier: Apache-2.0
// The command `bodyloom-cgal`: what needs CGAL, whose mesh packages are GPL. `bodyloom body info --check` starts it.
#include <CLI/CLI.hpp>

#include "apps/cgal/surface_tools.h"
#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"

int main(int argc, char** argv) {
  bodyloom::InstallSignalHandlers();
  CLI::App app("What bodyloom does with CGAL.", "bodyloom");
  app.require_subcommand(1);
  bodyloom::Action action;
  bodyloom::AddBodyVerb(app, &action, {}, {bodyloom::CrossingFaces, bodyloom::HoleFaces});
  return bodyloom::RunParsed(&app, "bodyloom", argc, argv, action);
}
