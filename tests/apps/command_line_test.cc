// SPDX-License-Identifier: Apache-2.0
// What the command line promises for every verb: help, usage errors, exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/exit_code.h"
#include "tests/apps/run_command.h"

namespace bodyloom {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Every verb, sub-verbs included.
const std::vector<std::vector<std::string>> kVerbs = {
    {"track"},           {"synth"},        {"evaluate"}, {"export"}, {"body"},   {"body", "info"},
    {"body", "convert"}, {"body", "make"}, {"demo"},     {"neural"}, {"version"}};

TEST(CommandLine, HelpNamesEveryVerbExamplesAndExitCodes) {
  const CommandResult result = RunCommand({"--help"});
  EXPECT_EQ(result.exit_code, kExitOk);
  EXPECT_EQ(result.err, "");
  for (const auto& verb : kVerbs) {
    EXPECT_THAT(result.out, HasSubstr("\n  " + verb[0] + " ")) << verb[0];
  }
  EXPECT_THAT(result.out, HasSubstr("Examples:"));
  EXPECT_THAT(result.out, HasSubstr(kExitCodeHelp));
}

TEST(CommandLine, EveryVerbHasHelp) {
  for (std::vector<std::string> verb : kVerbs) {
    verb.emplace_back("--help");
    const CommandResult result = RunCommand(verb);
    EXPECT_EQ(result.exit_code, kExitOk) << verb[0];
    EXPECT_EQ(result.err, "") << verb[0];
    EXPECT_THAT(result.out, HasSubstr("Usage: ")) << verb[0];
  }
}

TEST(CommandLine, UnknownOptionsOfEveryVerbAreUsageErrors) {
  for (std::vector<std::string> verb : kVerbs) {
    if (verb[0] == "neural") {
      continue;  // passes everything on
    }
    verb.emplace_back("--no-such-option");
    const CommandResult result = RunCommand(verb);
    EXPECT_EQ(result.exit_code, kExitUsage) << verb[0];
    EXPECT_EQ(result.out, "") << verb[0];
    EXPECT_THAT(result.err, StartsWith("bodyloom: ")) << verb[0];
  }
}

TEST(CommandLine, NoVerbAndUnknownVerbAreUsageErrors) {
  EXPECT_EQ(RunCommand({}).exit_code, kExitUsage);
  const CommandResult result = RunCommand({"frobnicate"});
  EXPECT_EQ(result.exit_code, kExitUsage);
  EXPECT_EQ(result.err, "bodyloom: no verb or option \"frobnicate\"\nRun with --help for the options.\n");
}

TEST(CommandLine, VersionIsOneLine) {
  const CommandResult result = RunCommand({"version"});
  EXPECT_EQ(result.exit_code, kExitOk);
  EXPECT_THAT(result.out, ::testing::MatchesRegex("bodyloom [0-9]+\\.[0-9]+\\.[0-9]+\n"));
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
}  // namespace bodyloom
