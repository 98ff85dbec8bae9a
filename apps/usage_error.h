// SPDX-License-Identifier: Apache-2.0
/// What was wrong with a command line, in one line.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace bodyloom {

/// The parser's own words, but for a verb that is unknown or missing, which it calls a missing subcommand: then what was
/// found in its place, and which verbs there are below the one that was given ("train: no verb "bogus", expected avatar,
/// motion or photo").
std::string UsageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace bodyloom
