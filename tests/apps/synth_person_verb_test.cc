// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "data_tools/datasets/multi_person_dataset.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/video/image_file.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom::synth_person_verb_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(SynthPersonVerb, WritesASetAndASheet) {
  const ScratchFolder scratch;
  const CommandResult result =
      RunCommand({"synth-person", "--motion", "demo", "--first", "100", "--frames", "5", "--out", scratch / "person",
                  "--size", "96", "--garment", "skirt", "--seed", "7", "--sheet", scratch / "sheet.jpg"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("5 frames of 96x96"));
  EXPECT_THAT(result.out, HasSubstr("cloth"));
  const SinglePersonDataset set(scratch / "person");
  EXPECT_EQ(set.info().num_frames, 5);
  EXPECT_EQ(set.info().seed, 7);
  EXPECT_EQ(set.info().garment, "skirt");
  EXPECT_EQ(set.info().motion, "demo");
  EXPECT_THAT(set.info().command, HasSubstr("--seed 7"));
  EXPECT_EQ(set.Read(4).labels.width, 96);
  EXPECT_GT(ReadImage(scratch / "sheet.jpg").width, 500);
}

TEST(SynthPersonVerb, SeveralMotionsFollowEachOtherWithAGap) {
  const ScratchFolder scratch;
  const CommandResult result =
      RunCommand({"synth-person", "--motion", "demo", "--motion", "demo", "--first", "40", "--frames", "4", "--out",
                  scratch / "person", "--size", "64", "--garment", "skirt"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const SinglePersonDataset set(scratch / "person");
  EXPECT_EQ(set.info().num_frames, 8);
  EXPECT_NEAR(set.info().fps, 30, 1e-6);
  EXPECT_EQ(set.info().motion, "demo demo");
  const std::vector<double> times = set.track().motion.timestamps;
  EXPECT_NEAR(times[4] - times[3], 1, 1e-9);
  EXPECT_NEAR(times[5] - times[4], 1 / 30.0, 1e-9);
  // The gap is a cut: the cloth of the second motion knows nothing of the first.
  EXPECT_THAT(result.out, HasSubstr(" 1 cuts"));
  for (int t = 0; t < 4; ++t) EXPECT_TRUE(set.Read(t).labels == set.Read(t + 4).labels) << t;
}

/// The light that is written is the light that is seen.
TEST(SynthPersonVerb, TheSamePersonInAnotherLight) {
  const ScratchFolder scratch;
  const auto make = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "synth-person", "--motion",  "demo",  "--first",      "40",
        "--frames",     "1",         "--out", scratch / name, "--size",
        "192",          "--garment", "suit",  "--light",      scratch / (name + ".json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = RunCommand(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr(name + ".json"));
    return SinglePersonDataset(scratch / name).Read(0);
  };
  const PersonFrame own = make("own", {}), other = make("other", {"--light-seed", "9"});
  EXPECT_FALSE(own.rgb == other.rgb);
  EXPECT_TRUE(own.labels == other.labels);
  EXPECT_TRUE(own.normals == other.normals);
  EXPECT_TRUE(own.background == other.background);
  EXPECT_THAT(SinglePersonDataset(scratch / "other").info().command, HasSubstr("--light-seed 9"));
  EXPECT_TRUE(make("again", {"--light-seed", "1"}).rgb == own.rgb) << "the seed's own";
  const auto shading = [&](const std::string& name, const Eigen::Vector3d& n) {
    const nlohmann::json light = nlohmann::json::parse(FileBytes(scratch / (name + ".json")));
    EXPECT_EQ(light["encoding"], "linear");
    double sum = light["ambient"];
    for (const auto& one : light["directional"]) {
      const std::vector<double> from = one["from"];  // the viewer's axes
      sum += one["intensity"].get<double>() * std::max(0.0, n.x() * from[0] - n.y() * from[1] - n.z() * from[2]);
    }
    return sum;
  };
  std::vector<double> errors;
  for (size_t i = 0; i < own.labels.bgr.size() / 3; i += 7) {
    const uint8_t* const code = &own.normals.bgr[3 * i];
    if (own.labels.bgr[3 * i] == 0 || own.rgb.bgr[3 * i] < 40) continue;
    const Eigen::Vector3d n(NormalOfCode(code[2]), NormalOfCode(code[1]), NormalOfCode(code[0]));
    const double seen = double(other.rgb.bgr[3 * i]) / own.rgb.bgr[3 * i];
    errors.push_back(std::abs(seen / (shading("other", n) / shading("own", n)) - 1));
  }
  ASSERT_GT(errors.size(), 200U);
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.01);
}

TEST(SynthPersonVerb, TheSameCutOfAnotherStuff) {
  const ScratchFolder scratch;
  const auto make = [&](const std::string& material) {
    const CommandResult result = RunCommand({"synth-person", "--motion", "demo", "--first", "40", "--frames", "1",
                                             "--out", scratch / material, "--size", "64", "--material", material});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return SinglePersonDataset(scratch / material);
  };
  const SinglePersonDataset cotton = make("cotton"), silk = make("silk");
  EXPECT_FALSE(cotton.Read(0).labels == silk.Read(0).labels);
  EXPECT_TRUE(cotton.Read(0).iuv == silk.Read(0).iuv) << "the body is the same";
  EXPECT_THAT(silk.info().command, HasSubstr("--material silk"));
  EXPECT_THAT(cotton.info().command, Not(HasSubstr("--material")));
  const CommandResult other =
      RunCommand({"synth-person", "--motion", "demo", "--out", scratch / "p", "--material", "tin"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("tin not in {cotton,silk,denim}"));
}

TEST(SynthPersonVerb, TheSamePosesAtTwoSpeeds) {
  const ScratchFolder scratch;
  const auto make = [&](const std::string& name, const std::vector<std::string>& speeds) {
    std::vector<std::string> arguments = {"synth-person", "--motion",  "demo",  "--first",      "40",
                                          "--frames",     "5",         "--out", scratch / name, "--size",
                                          "64",           "--garment", "skirt"};
    arguments.insert(arguments.end(), speeds.begin(), speeds.end());
    const CommandResult result = RunCommand(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return SinglePersonDataset(scratch / name).track().motion;
  };
  const Motion normal = make("normal", {}), slow = make("slow", {"--speed", "0.5"}),
               both = make("both", {"--speed", "1", "--speed", "0.5"});
  ASSERT_EQ(normal.num_frames(), 5);
  ASSERT_EQ(slow.num_frames(), 9);
  ASSERT_EQ(both.num_frames(), 14);
  for (int t = 0; t < 5; ++t) {
    EXPECT_LT((normal.poses.row(t) - slow.poses.row(2 * t)).cwiseAbs().maxCoeff(), 1e-9) << t;
    EXPECT_NEAR(slow.timestamps[2 * t], 2 * normal.timestamps[t], 1e-9);
  }
  EXPECT_GT((normal.poses.row(0) - normal.poses.row(4)).cwiseAbs().maxCoeff(), 1e-3) << "somebody who stands still";
  EXPECT_THAT(SinglePersonDataset(scratch / "both").info().command, HasSubstr("--speed 1 --speed 0.5"));
  const CommandResult rateless =
      RunCommand({"synth-person", "--motion", "demo", "--out", scratch / "p", "--fps", "0", "--speed", "0.5"});
  EXPECT_EQ(rateless.exit_code, 2);
  EXPECT_THAT(rateless.err, HasSubstr("--speed needs --fps"));
  EXPECT_EQ(RunCommand({"synth-person", "--motion", "demo", "--out", scratch / "p", "--speed", "0"}).exit_code, 2);
}

TEST(SynthPersonVerb, SaysWhatIsWrong) {
  const ScratchFolder scratch;
  const auto run = [&](const std::string& option, const std::string& value) {
    return RunCommand({"synth-person", "--motion", "demo", "--out", scratch / "p", "--frames", "2", option, value});
  };
  EXPECT_EQ(run("--garment", "kilt").exit_code, 2);
  EXPECT_EQ(run("--size", "7").exit_code, 2);
  EXPECT_EQ(run("--first", "-3").exit_code, 2);
  const CommandResult late = run("--first", "100000");
  EXPECT_EQ(late.exit_code, 1);
  EXPECT_THAT(late.err, HasSubstr("--first asks for frame 100000"));
  const CommandResult missing = RunCommand({"synth-person", "--motion", scratch / "no.bvh", "--out", scratch / "p"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("no.bvh"));
  EXPECT_EQ(missing.NumErrorLines(), 1);
}

TEST(SynthPersonVerb, AnInterruptionLeavesNoFinishedSet) {
  const ScratchFolder scratch;
  const CommandResult result =
      RunCommand({"synth-person", "--motion", "demo", "--out", scratch / "person", "--size", "64"},
                 {.file_size_limit = {}, .interrupt_on = "% person", .work_folder = ""});
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_FALSE(std::filesystem::exists(scratch / "person/person.json"));
}

TEST(SynthPeopleVerb, WritesASetAndASheet) {
  const ScratchFolder scratch;
  const CommandResult result =
      RunCommand({"synth-people", "--motions", "demo", "--out", scratch / "people", "--people", "2", "--actions", "1",
                  "--views", "2", "--frames", "2", "--size", "64", "--sheet", scratch / "sheet.png"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("8 images of 2 people"));
  const MultiPersonDataset set = ReadMultiPersonDataset(scratch / "people");
  EXPECT_EQ(set.people.size(), 2U);
  EXPECT_THAT(set.command, HasSubstr("--every 6"));
  EXPECT_GT(ReadImage(scratch / "sheet.png").width, 500);
}

TEST(SynthPeopleVerb, DressesPeopleAsTheyDressEveryDay) {
  const ScratchFolder scratch;
  const auto make = [&](const std::string& name, const std::string& clothes) {
    return RunCommand({"synth-people", "--motions", "demo", "--out", scratch / name, "--people", "1", "--actions", "1",
                       "--views", "1", "--frames", "1", "--size", "64", "--clothes", clothes});
  };
  for (const char* clothes : {"patterned", "everyday"}) ASSERT_EQ(make(clothes, clothes).exit_code, 0) << clothes;
  const std::string image = "p000/a0_v0/images/000000.png";
  EXPECT_FALSE(ReadImage(scratch / ("patterned/" + image)).bgr == ReadImage(scratch / ("everyday/" + image)).bgr);
  EXPECT_THAT(ReadMultiPersonDataset(scratch / "everyday").command, HasSubstr("--clothes everyday"));
  const CommandResult other = make("other", "fancy");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("fancy not in {patterned,everyday}"));
}

TEST(SynthPeopleVerb, PutsPeopleIntoNaturalLight) {
  const ScratchFolder scratch;
  const auto make = [&](const std::string& name, const std::string& style) {
    return RunCommand({"synth-people", "--motions", "demo", "--out", scratch / name, "--people", "1", "--actions", "1",
                       "--views", "1", "--frames", "1", "--size", "64", "--light-style", style});
  };
  for (const char* style : {"studio", "natural"}) ASSERT_EQ(make(style, style).exit_code, 0) << style;
  const std::string clip = "p000/a0_v0/", frame = "/000000.png";
  EXPECT_FALSE(ReadImage(scratch / ("studio/" + clip + "images" + frame)).bgr ==
               ReadImage(scratch / ("natural/" + clip + "images" + frame)).bgr);
  EXPECT_TRUE(ReadImage(scratch / ("studio/" + clip + "labels" + frame)).bgr ==
              ReadImage(scratch / ("natural/" + clip + "labels" + frame)).bgr);
  EXPECT_THAT(ReadMultiPersonDataset(scratch / "natural").command, HasSubstr("--light-style natural"));
  EXPECT_EQ(make("other", "sun").exit_code, 2);
}

TEST(SynthPeopleVerb, SaysWhatIsWrong) {
  const ScratchFolder scratch;
  const CommandResult longer =
      RunCommand({"synth-people", "--motions", "demo", "--out", scratch / "p", "--frames", "500", "--every", "10"});
  EXPECT_EQ(longer.exit_code, 2);
  EXPECT_THAT(longer.err, HasSubstr("none is as long as a clip, 4991 frames"));
  const CommandResult missing = RunCommand({"synth-people", "--motions", scratch / "none", "--out", scratch / "p"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("none"));
}

}  // namespace
}  // namespace bodyloom::synth_person_verb_test
