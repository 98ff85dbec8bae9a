// SPDX-License-Identifier: Apache-2.0
// Properties of the command line common to all verbs: help, usage errors, exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/usage_error.h"
#include "tests/support/run_command.h"

namespace bodyloom::command_line_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

using Verbs = std::vector<std::vector<std::string>>;

/// Those of this program, sub-verbs included.
const Verbs kOwnVerbs = {{"track"},   {"synth"},  {"synth-person"}, {"synth-people"}, {"evaluate"},
                         {"metrics"}, {"export"}, {"render"},       {"describe"},     {"texture"},
                         {"parse"},   {"body"},   {"body", "info"}, {"body", "make"}, {"body", "convert"},
                         {"demo"},    {"prior"},  {"motions"},      {"version"}};
/// Those that it passes on to the program that LibTorch is linked with.
const Verbs kNeuralVerbs = {{"neural"},           {"neural", "doctor"}, {"neural", "card"},    {"train"},
                            {"train", "lifter"},  {"train", "motion"},  {"train", "photo"},    {"train", "guided"},
                            {"train", "parser"},  {"animate"},          {"animate", "motion"}, {"animate", "photo"},
                            {"animate", "guided"}};

/// All that were built.
Verbs AllVerbs() {
  Verbs verbs = kOwnVerbs;
  if (BODYLOOM_HAS_NEURAL) verbs.insert(verbs.end(), kNeuralVerbs.begin(), kNeuralVerbs.end());
  return verbs;
}

std::string Spelled(const std::vector<std::string>& verb) {
  return verb.size() == 1 ? verb[0] : verb[0] + " " + verb[1];
}

TEST(CommandLine, HelpNamesEveryVerbExamplesAndExitCodes) {
  const CommandResult result = RunCommand({"--help"});
  EXPECT_EQ(result.exit_code, kExitOk);
  EXPECT_EQ(result.err, "");
  for (const Verbs& verbs : {kOwnVerbs, kNeuralVerbs}) {
    for (const auto& verb : verbs) EXPECT_THAT(result.out, HasSubstr("\n  " + verb[0] + " "));
  }
  EXPECT_THAT(result.out, HasSubstr("Examples:"));
  EXPECT_THAT(result.out, HasSubstr(kExitCodeHelp));
}

TEST(CommandLine, EveryVerbHasHelp) {
  for (std::vector<std::string> verb : AllVerbs()) {
    const std::string spelled = Spelled(verb);
    verb.emplace_back("--help");
    const CommandResult result = RunCommand(verb);
    EXPECT_EQ(result.exit_code, kExitOk) << spelled;
    EXPECT_EQ(result.err, "") << spelled;
    EXPECT_THAT(result.out, HasSubstr("Usage: bodyloom " + spelled + " ["));
  }
}

TEST(CommandLine, HelpOfAVerbNamesItsOwnVerbs) {
  for (const std::vector<std::string>& verb : AllVerbs()) {
    if (verb.size() == 1) continue;
    EXPECT_THAT(RunCommand({verb[0], "--help"}).out, HasSubstr("\n  " + verb[1] + " ")) << verb[0];
  }
}

TEST(CommandLine, UnknownOptionsOfEveryVerbAreUsageErrors) {
  for (std::vector<std::string> verb : AllVerbs()) {
    const std::string spelled = Spelled(verb);
    verb.emplace_back("--no-such-option");
    const CommandResult result = RunCommand(verb);
    EXPECT_EQ(result.exit_code, kExitUsage) << spelled;
    EXPECT_EQ(result.out, "") << spelled;
    EXPECT_THAT(result.err, StartsWith(verb[0] == "neural" ? "bodyloom neural: " : "bodyloom: ")) << spelled;
  }
}

TEST(CommandLine, NoVerbAndUnknownVerbAreUsageErrors) {
  EXPECT_EQ(RunCommand({}).exit_code, kExitUsage);
  EXPECT_EQ(RunCommand({}).err, "bodyloom: no verb\nRun with --help for the options.\n");
  const CommandResult result = RunCommand({"frobnicate"});
  EXPECT_EQ(result.exit_code, kExitUsage);
  EXPECT_EQ(result.err, "bodyloom: no verb or option \"frobnicate\"\nRun with --help for the options.\n");
}

TEST(CommandLine, AVerbOfAVerbThatIsUnknownOrMissingIsNamedWithThoseThereAre) {
  const CommandResult unknown = RunCommand({"body", "frobnicate"}), missing = RunCommand({"body"});
  EXPECT_EQ(unknown.exit_code, kExitUsage);
  EXPECT_THAT(unknown.err,
              StartsWith("bodyloom: body: no verb or option \"frobnicate\", expected info, convert or make\n"));
  EXPECT_EQ(missing.exit_code, kExitUsage);
  EXPECT_THAT(missing.err, StartsWith("bodyloom: body: no verb, expected info, convert or make\n"));
  EXPECT_THAT(RunCommand({"body", "convert"}).err, StartsWith("bodyloom: --body is required\n"));
}

TEST(CommandLine, VersionIsOneLine) {
  for (const char* way : {"version", "--version"}) {
    const CommandResult result = RunCommand({way});
    EXPECT_EQ(result.exit_code, kExitOk) << way;
    EXPECT_THAT(result.out, ::testing::MatchesRegex("bodyloom [0-9]+\\.[0-9]+\\.[0-9]+\n")) << way;
  }
}

TEST(CommandLine, NeuralVerbsRunOrSayThatTheyWereNotBuilt) {
  const CommandResult result = RunCommand({"neural", "doctor"});
  if (BODYLOOM_HAS_NEURAL) {
    EXPECT_EQ(result.exit_code, kExitOk) << result.err;
    EXPECT_THAT(result.out, StartsWith("LibTorch "));
    EXPECT_EQ(RunCommand({"neural", "no-such-verb"}).exit_code, kExitUsage);
  } else {
    EXPECT_EQ(result.exit_code, kExitFailed);
    EXPECT_THAT(result.err, HasSubstr("bodyloom-neural: not there"));
    EXPECT_EQ(result.NumErrorLines(), 1);
  }
}

}  // namespace
}  // namespace bodyloom::command_line_test
