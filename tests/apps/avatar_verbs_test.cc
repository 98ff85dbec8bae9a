// SPDX-License-Identifier: Apache-2.0
// `bodyloom train avatar` and `bodyloom animate avatar`, and their place among verbs that need LibTorch.
#include <gmock/gmock.h>

#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/video_reader.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::avatar_verbs_test {
namespace {

using ::testing::HasSubstr;

TEST(AvatarVerbs, HelpNamesAllVerbsWithoutLibTorch) {
  const CommandResult train = RunCommand({"train", "--help"}), animate = RunCommand({"animate", "--help"});
  EXPECT_EQ(train.exit_code, 0);
  EXPECT_EQ(animate.exit_code, 0);
  for (const char* verb : {"avatar", "motion", "photo", "guided", "lifter", "parser"})
    EXPECT_THAT(train.out, HasSubstr(verb));
  for (const char* verb : {"avatar", "motion", "photo", "guided"}) EXPECT_THAT(animate.out, HasSubstr(verb));
  EXPECT_THAT(RunCommand({"train", "avatar", "--help"}).out, HasSubstr("--minutes"));
  EXPECT_THAT(RunCommand({"animate", "avatar", "--help"}).out, HasSubstr("--view-yaw"));
}

TEST(AvatarVerbs, LearnShowAndGoOn) {
  const ScratchFolder scratch;
  ASSERT_EQ(
      RunCommand({"synth-person", "--motion", "demo", "--frames", "6", "--size", "96", "--out", scratch / "person"})
          .exit_code,
      0);
  const std::vector<std::string> train = {
      "train", "avatar",  "--data", scratch / "person", "--out", scratch / "run", "--steps", "20", "--skin",
      "48",    "--loose", "300",    "--train",          "0-3",   "--validate",    "4-5"};
  const CommandResult trained = RunCommand(train);
  ASSERT_EQ(trained.exit_code, 0) << trained.err;
  EXPECT_THAT(trained.out, HasSubstr("20 steps"));
  EXPECT_THAT(trained.out, HasSubstr("frames held out, 2 frames: PSNR"));
  const CommandResult again = RunCommand(train);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("--resume"));
  const CommandResult shown =
      RunCommand({"animate", "avatar", "--run", scratch / "run", "--track", scratch / "person/track.npz", "--view-yaw",
                  "0:90", "--out", scratch / "turned.mp4", "--size", "64", "--ply", scratch / "rest.ply"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_EQ(VideoReader(scratch / "turned.mp4").info().num_frames, 6);
  EXPECT_GT(std::filesystem::file_size(scratch / "rest.ply"), 1000U);
  const CommandResult page = RunCommand({"animate", "avatar", "--run", scratch / "run", "--track",
                                         scratch / "person/track.npz", "--report", scratch / "page.html"});
  ASSERT_EQ(page.exit_code, 0) << page.err;
  EXPECT_THAT(ReadFileBytes(scratch / "page.html"), HasSubstr("id=\"changes\""));
}

TEST(AvatarVerbs, WrongUseIsSaidInALine) {
  const ScratchFolder scratch;
  EXPECT_EQ(RunCommand({"train"}).exit_code, 2);
  EXPECT_EQ(RunCommand({"train", "avatar"}).exit_code, 2);
  EXPECT_EQ(RunCommand({"train", "avatar", "--data", "x", "--out", "y", "--steps", "5", "--minutes", "1"}).exit_code,
            2);
  EXPECT_EQ(RunCommand({"animate", "avatar", "--run", "x"}).exit_code, 2);
  const CommandResult turned = RunCommand(
      {"animate", "avatar", "--run", "x", "--track", "y.npz", "--report", scratch / "p.html", "--view-yaw", "90"});
  EXPECT_EQ(turned.exit_code, 2);
  EXPECT_THAT(turned.err, HasSubstr("--report turns by hand"));
  const CommandResult missing = RunCommand(
      {"animate", "avatar", "--run", scratch / "no", "--track", scratch / "no.npz", "--out", scratch / "o.mp4"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_EQ(missing.NumErrorLines(), 1) << missing.err;
  EXPECT_THAT(missing.err, HasSubstr("no"));
}

}  // namespace
}  // namespace bodyloom::avatar_verbs_test
