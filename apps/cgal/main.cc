// SPDX-License-Identifier: Apache-2.0
// The command `bodyloom-cgal`: what needs CGAL, whose mesh packages are GPL. `bodyloom body info --check` starts it.
#include <CLI/CLI.hpp>

#include "apps/cgal/crossing_faces.h"
#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"

int main(int argc, char** argv) {
  bodyloom::InstallSignalHandlers();
  CLI::App app("What bodyloom does with CGAL.", "bodyloom");
  app.require_subcommand(1);
  bodyloom::Action action;
  bodyloom::AddBodyVerb(app, &action, {}, bodyloom::CrossingFaces);
  return bodyloom::RunParsed(&app, "bodyloom", argc, argv, action);
}
