// SPDX-License-Identifier: Apache-2.0
#include "apps/run_parsed.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/usage_error.h"

namespace bodyloom {

int RunParsed(CLI::App* app, const std::string& name, int argc, char** argv, const Action& action) {
  const auto wrong_usage = [&](const std::string& error) {
    std::cerr << name << ": " << error << "\nRun with --help for the options.\n";
    return kExitUsage;
  };
  try {
    app->parse(argc, argv);
    action();
    return kExitOk;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help
      return app->exit(error);
    }
    return wrong_usage(UsageError(*app, error));
  } catch (const RequestError& error) {
    return wrong_usage(error.what());
  } catch (const Cancelled&) {
    std::cerr << name << ": interrupted\n";
    return kExitInterrupted;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return IsInterrupted() ? kExitInterrupted : kExitFailed;
  }
}

}  // namespace bodyloom
