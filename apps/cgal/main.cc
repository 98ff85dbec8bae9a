// SPDX-License-Identifier: Apache-2.0
// The command `bodyloom-cgal`: what needs CGAL, whose mesh packages are GPL. `bodyloom body info --check` starts it.
#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <iostream>

#include "apps/cgal/crossing_faces.h"
#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/verbs.h"

int main(int argc, char** argv) {
  bodyloom::InstallSignalHandlers();
  CLI::App app("What bodyloom does with CGAL.", "bodyloom");
  app.require_subcommand(1);
  bodyloom::Action action;
  bodyloom::AddBodyVerb(app, &action, {}, bodyloom::CrossingFaces);
  try {
    app.parse(argc, argv);
    action();
    return bodyloom::kExitOk;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      return app.exit(error);
    }
    std::cerr << "bodyloom: " << error.what() << "\nRun with --help for the options.\n";
    return bodyloom::kExitUsage;
  } catch (const bodyloom::RequestError& error) {
    std::cerr << "bodyloom: " << error.what() << "\nRun with --help for the options.\n";
    return bodyloom::kExitUsage;
  } catch (const std::exception& error) {
    std::cerr << "bodyloom: " << (bodyloom::IsInterrupted() ? "interrupted" : error.what()) << "\n";
    return bodyloom::IsInterrupted() ? bodyloom::kExitInterrupted : bodyloom::kExitFailed;
  }
}
