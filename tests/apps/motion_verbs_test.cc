// SPDX-License-Identifier: Apache-2.0
// `motions` and `train lifter` on synthetic motions.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/bvh_writer.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::motion_verbs_test {
namespace {

/// Two motions and a split that keeps one of them for testing.
void WriteMotions(const ScratchFolder& folder) {
  std::filesystem::create_directories(folder / "motions");
  WriteBvh(folder / "motions/a.bvh", DemoMotion(BuiltinBody(), 150, 30), BuiltinBody());
  WriteBvh(folder / "motions/b.bvh", DemoMotion(BuiltinBody(), 120, 30), BuiltinBody());
  std::ofstream(folder / "split.txt") << "a dance train\nb dance test\n";
}

TEST(MotionsVerb, CountsWhatItFinds) {
  const ScratchFolder folder;
  WriteMotions(folder);
  const CommandResult result = RunCommand({"motions", "--motions", folder / "motions", "--split", folder / "split.txt",
                                           "--json", folder / "report.json", "--sheet", folder / "sheet.png"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::ifstream file(folder / "report.json");
  EXPECT_TRUE(nlohmann::json::parse(file).is_object());
  EXPECT_GT(std::filesystem::file_size(folder / "sheet.png"), 1000U);
}

TEST(MotionsVerb, ABrokenSplitIsNamedWithItsLine) {
  const ScratchFolder folder;
  WriteMotions(folder);
  std::ofstream(folder / "split.txt") << "a dance train\nb dance maybe\n";
  const CommandResult result =
      RunCommand({"motions", "--motions", folder / "motions", "--split", folder / "split.txt"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.NumErrorLines(), 1) << result.err;
  EXPECT_NE(result.err.find("split.txt"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find('2'), std::string::npos) << result.err;
}

TEST(MotionsVerb, AFolderThatIsNotThere) {
  const CommandResult result = RunCommand({"motions", "--motions", "/no/such/folder"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("/no/such/folder"), std::string::npos) << result.err;
}

#if BODYLOOM_HAS_NEURAL
std::vector<std::string> Training(const ScratchFolder& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {
      "train",        "lifter",  "--motions", folder / "motions", "--split", folder / "split.txt", "--out",
      folder / "run", "--steps", "4",         "--batch",          "2",       "--channels",         "8",
      "--threads",    "1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(TrainLifterVerb, TrainsAndLeavesAWholeRun) {
  const ScratchFolder folder;
  WriteMotions(folder);
  const CommandResult result = RunCommand(Training(folder));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* name : {"config.json", "metrics.csv", "checkpoint.bin", "lifter.npz"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "run" + "/" + name)) << name;
  }
  const CommandResult again = RunCommand(Training(folder));
  EXPECT_EQ(again.exit_code, 2) << "a run is not overwritten";
  EXPECT_NE(again.err.find("--resume"), std::string::npos) << again.err;
  EXPECT_EQ(RunCommand(Training(folder, {"--resume"})).exit_code, 0);
}

TEST(TrainLifterVerb, BeginsWithTheWeightsOfAnotherRun) {
  const ScratchFolder folder;
  WriteMotions(folder);
  ASSERT_EQ(RunCommand(Training(folder)).exit_code, 0);
  std::filesystem::rename(folder / "run", folder / "first");
  const std::vector<std::string> from = {"--init-from", folder / "first/lifter.npz"};
  ASSERT_EQ(RunCommand(Training(folder, from)).exit_code, 0);
  ASSERT_EQ(RunCommand(Training(folder, {"--resume"})).exit_code, 0);
  std::ifstream file(folder / "run/config.json");
  EXPECT_EQ(nlohmann::json::parse(file)["init_from"], folder / "first/lifter.npz") << "a run that went on forgot it";
  const CommandResult both = RunCommand(Training(folder, {"--resume", "--init-from", folder / "first/lifter.npz"}));
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_NE(both.err.find("leave --init-from out"), std::string::npos) << both.err;
  std::filesystem::remove_all(folder / "run");
  const CommandResult wider =
      RunCommand({"train", "lifter", "--motions", folder / "motions", "--split", folder / "split.txt", "--out",
                  folder / "run", "--channels", "16", from[0], from[1]});
  EXPECT_EQ(wider.exit_code, 1);
  EXPECT_EQ(wider.NumErrorLines(), 1) << wider.err;
  EXPECT_NE(wider.err.find("weights of 8 channels"), std::string::npos) << wider.err;
}

TEST(TrainLifterVerb, WrongUseIsSaid) {
  const ScratchFolder folder;
  WriteMotions(folder);
  EXPECT_EQ(RunCommand({"train"}).exit_code, 2);
  EXPECT_EQ(RunCommand({"train", "lifter"}).exit_code, 2);
  EXPECT_EQ(RunCommand(Training(folder, {"--share", "7"})).exit_code, 2);
  std::ofstream(folder / "split.txt") << "a dance train\nb dance train\n";
  const CommandResult result = RunCommand(Training(folder));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("validation"), std::string::npos) << result.err;
  EXPECT_EQ(RunCommand({"train", "lifter", "--help"}).exit_code, 0);
}
#endif

TEST(TrackVerb, ALifterFileThatIsNone) {
  const ScratchFolder folder;
  std::ofstream(folder / "lifter.npz") << "not weights";
  ASSERT_EQ(RunCommand({"synth", "--motion", "demo", "--frames", "5", "--out", folder / "clip"}).exit_code, 0);
  const CommandResult result = RunCommand({"track", "--detections", folder / "clip/observations.npz", "--out",
                                           folder / "t.npz", "--lifter", folder / "lifter.npz"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("lifter.npz"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "t.npz"));
}

}  // namespace
}  // namespace bodyloom::motion_verbs_test
