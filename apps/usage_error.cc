// SPDX-License-Identifier: Apache-2.0
#include "apps/usage_error.h"

#include <CLI/CLI.hpp>
#include <vector>

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

}  // namespace bodyloom
