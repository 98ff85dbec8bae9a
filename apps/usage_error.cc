// SPDX-License-Identifier: Apache-2.0
#include "apps/usage_error.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <vector>

#include "apps/progress.h"

namespace bodyloom {
namespace {

/// "a, b or c"
std::string Alternatives(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 < names.size() ? ", " : " or ";
    text += names[i];
  }
  return text;
}

std::vector<std::string> VerbsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!verb->get_name().empty()) names.push_back(verb->get_name());
  }
  return names;
}

}  // namespace

std::string UsageError(const CLI::App& app, const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::RequiredError*>(&error) == nullptr) return error.what();
  const CLI::App* given = &app;
  std::string path;
  while (!given->get_subcommands().empty()) {
    given = given->get_subcommands().front();
    path += (path.empty() ? "" : " ") + given->get_name();
  }
  if (given->get_require_subcommand_min() == 0) return error.what();
  const std::vector<std::string> left = app.remaining(true);
  if (path.empty()) return left.empty() ? "no verb" : "no verb or option \"" + left.front() + "\"";
  const std::string expected = "expected " + Alternatives(VerbsOf(*given));
  return path + (left.empty() ? ": no verb, " : ": no verb or option \"" + left.front() + "\", ") + expected;
}

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
