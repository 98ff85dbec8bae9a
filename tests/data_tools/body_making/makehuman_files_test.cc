// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body_making/makehuman_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "bodyloom/data_tools/body_making/import_makehuman.h"
#include "bodyloom/data_tools/body_making/makehuman_population.h"
#include "tests/data_tools/body_making/mini_makehuman.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom {
namespace {

const char kObj[] = "base.obj", kRig[] = "rigs/standard/rig.game_engine.json",
           kWeights[] = "rigs/standard/weights.game_engine.json",
           kTarget[] = "targets/macrodetails/universal-male-young-averagemuscle-averageweight.target.gz";

/// Writes the folder with one file changed and returns the message of the error.
std::string ErrorWith(const std::string& name, const std::string& contents) {
  const TemporaryFolder folder;
  MiniMakeHuman mini(folder.File("makehuman"));
  mini.files()[name] = contents;
  mini.Write();
  return FileErrorOf(std::filesystem::path(name).filename().string(), [&] { ReadMakeHuman(mini.folder()); });
}

std::string Original(const std::string& name) { return MiniMakeHuman("unused").files().at(name); }

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(MakeHumanFiles, ReadsTheFolder) {
  const TemporaryFolder folder;
  MiniMakeHuman mini(folder.File("makehuman"));
  mini.Write();
  const MakeHumanFiles files = ReadMakeHuman(mini.folder());
  EXPECT_EQ(files.num_body_vertices, 8 * 52);
  EXPECT_EQ(files.quads.size(), 6u * 52);
  EXPECT_EQ(files.bones.size(), 53u);
  EXPECT_EQ(files.joint_cubes.at("joint-l-knee").size(), 8u);
  EXPECT_EQ(files.targets.size(), 6u);
  for (size_t b = 0; b < files.bones.size(); ++b) EXPECT_LT(files.bones[b].parent, static_cast<int>(b));
  EXPECT_EQ(files.bones[files.FindBone("calf_l")].parent, files.FindBone("thigh_l"));
  EXPECT_EQ(files.FindBone("tail"), -1);
}

TEST(MakeHumanFiles, MissingFiles) {
  FileErrorOf("/nowhere/base.obj", [] { ReadMakeHuman("/nowhere"); });
  for (const char* name : {kObj, kRig, kWeights}) {
    const TemporaryFolder folder;
    MiniMakeHuman mini(folder.File("makehuman"));
    mini.files().erase(name);
    mini.Write();
    FileErrorOf(std::filesystem::path(name).filename().string(), [&] { ReadMakeHuman(mini.folder()); });
  }
  const TemporaryFolder folder;
  MiniMakeHuman mini(folder.File("makehuman"));
  std::erase_if(mini.files(), [](const auto& file) { return file.first.starts_with("targets"); });
  mini.Write();
  FileErrorOf("macrodetails", [&] { ReadMakeHuman(mini.folder()); });
}

TEST(MakeHumanFiles, RefusesBadMeshes) {
  const std::string obj = Original(kObj);
  ErrorWith(kObj, Replaced(obj, "g body", "g torso"));
  ErrorWith(kObj, Replaced(obj, "v ", "v nan "));
  ErrorWith(kObj, Replaced(obj, "\nf 4/1", "\nf 4"));
  ErrorWith(kObj, Replaced(obj, "\nf 4/1", "\nf 99999/1"));
  ErrorWith(kObj, Replaced(obj, "\nf 4/1 3/2 2/3 1/4\n", "\nf 4/1 3/2 2/3\n"));
  ErrorWith(kObj, Replaced(obj, "\nf 4/1", "\n  f 4/1"));
  ErrorWith(kObj, Replaced(obj, "\nf 4/1 3/2 2/3 1/4\n", "\nf 4/1 3/2 2/3 600/4\n"));
  ErrorWith(kObj, "");
}

TEST(MakeHumanFiles, RefusesBadRigs) {
  const std::string rig = Original(kRig);
  ErrorWith(kRig, Replaced(rig, R"("parent": "thigh_l")", R"("parent": "calf_l")"));  // its own parent
  ErrorWith(kRig, Replaced(rig, R"("parent": "thigh_l")", R"("parent": "nobody")"));
  ErrorWith(kRig, Replaced(rig, "joint-l-knee", "joint-l-wing"));
  ErrorWith(kRig, Replaced(rig, R"("strategy": "CUBE", "cube_name": "joint-l-knee")",
                           R"("strategy": "MEAN", "vertex_indices": [99999])"));
  ErrorWith(kRig, Replaced(rig, R"("strategy": "CUBE", "cube_name": "joint-l-knee")",
                           R"("strategy": "MEAN", "vertex_indices": [])"));
  ErrorWith(kRig, Replaced(rig, R"("strategy": "CUBE", "cube_name": "joint-l-knee")", R"("strategy": 5)"));
  ErrorWith(kRig, "[]");
  ErrorWith(kRig, "{}");
  ErrorWith(kRig, std::string(100'000, '['));
}

TEST(MakeHumanFiles, RefusesBadWeights) {
  const std::string weights = Original(kWeights);
  ErrorWith(kWeights, Replaced(weights, "[0, 1.0]", "[-1, 1.0]"));
  ErrorWith(kWeights, Replaced(weights, "[0, 1.0]", "[99999, 1.0]"));
  ErrorWith(kWeights, Replaced(weights, "[0, 1.0]", "[0.5, 1.0]"));
  ErrorWith(kWeights, Replaced(weights, "[0, 1.0]", "[0, 1e300]"));
  ErrorWith(kWeights, Replaced(weights, "[0, 1.0]", "[0, NaN]"));
  ErrorWith(kWeights, Replaced(weights, "[0, 1.0]", "[0]"));
  EXPECT_NE(ErrorWith(kWeights, Replaced(weights, "[0, 1.0]", "[0, 0]")).find("vertex 0"), std::string::npos);
  ErrorWith(kWeights, "{}");
}

TEST(MakeHumanFiles, RefusesBadTargets) {
  for (const char* line : {"0 1 2\n", "0 1 2 3 4\n", "x 1 2 3\n", "0 1 2 nan\n", "0 1 2 1e99\n", "-1 0 0 0\n",
                           "0.5 0 0 0\n", "99999999 0 0 0\n", "99999999999999999999 0 0 0\n"}) {
    EXPECT_NE(ErrorWith(kTarget, std::string("1 0 0 0\n# comment\n") + line).find("line 3"), std::string::npos) << line;
  }
  ErrorWith(kTarget, std::string(size_t{17} << 20, ' '));  // a bomb: 17 MB packed into 17 kB
}

TEST(MakeHumanFiles, RefusesTruncation) {
  const TemporaryFolder folder;
  MiniMakeHuman mini(folder.File("makehuman"));
  mini.Write();
  for (const char* name : {kObj, kRig, kWeights}) {
    const std::string& whole = mini.files().at(name);
    const std::filesystem::path path = std::filesystem::path(mini.folder()) / name;
    for (size_t i = 0; i < 60; ++i) {
      std::ofstream(path, std::ios::binary) << whole.substr(0, i * (whole.size() - 10) / 60);
      FileErrorOf(path.filename().string(), [&] { ReadMakeHuman(mini.folder()); });
    }
    std::ofstream(path, std::ios::binary) << whole;
  }
  const std::string path = mini.folder() + "/" + kTarget;
  const auto size = std::filesystem::file_size(path);
  for (size_t cut = size; cut-- > 0;) {
    if (cut > 40 && cut % 61 != 0) continue;
    std::filesystem::resize_file(path, cut);
    FileErrorOf("universal-male", [&] { ReadGzip(path, 1 << 24); });
  }
  std::ofstream(path, std::ios::binary) << "this is no gzip file";
  FileErrorOf("universal-male", [&] { ReadGzip(path, 1 << 24); });
}

TEST(MakeHumanFiles, ImportNeedsTheGameEngineRig) {
  const TemporaryFolder folder;
  MiniMakeHuman mini(folder.File("makehuman"));
  std::string& rig = mini.files()[kRig];
  for (size_t at = rig.find("middle_"); at != std::string::npos; at = rig.find("middle_", at))
    rig.replace(at, 7, "medius_");
  std::string& weights = mini.files()[kWeights];
  for (size_t at = weights.find("middle_"); at != std::string::npos; at = weights.find("middle_", at)) {
    weights.replace(at, 7, "medius_");
  }
  mini.Write();
  const std::string message = FileErrorOf(mini.folder(), [&] { ImportMakeHuman(mini.folder()); });
  EXPECT_NE(message.find("middle_01_l"), std::string::npos) << message;
}

TEST(MakeHumanPopulation, TargetWeights) {
  MakeHumanPerson person;
  person.male = 1;
  person.age = 0.5;
  person.muscle = 0.25;
  person.weight = 0.75;
  person.height = 0.24;
  person.proportions = 0.5;
  person.ancestry = {0, 0.25, 0.75};
  const std::map<std::string, double> expected = {
      {"asian-male-young", 0.25},
      {"caucasian-male-young", 0.75},
      {"universal-male-young-minmuscle-averageweight", 0.25},
      {"universal-male-young-minmuscle-maxweight", 0.25},
      {"universal-male-young-averagemuscle-averageweight", 0.25},
      {"universal-male-young-averagemuscle-maxweight", 0.25},
      {"male-young-minmuscle-averageweight-minheight", 0.125},
      {"male-young-minmuscle-maxweight-minheight", 0.125},
      {"male-young-averagemuscle-averageweight-minheight", 0.125},
      {"male-young-averagemuscle-maxweight-minheight", 0.125},
  };
  const std::map<std::string, double> weights = MakeHumanTargetWeights(person);
  ASSERT_EQ(weights.size(), expected.size());
  for (const auto& [name, weight] : expected) EXPECT_NEAR(weights.at(name), weight, 1e-12) << name;
  // Beyond the slider's end the last piece is extended.
  person.weight = 1.5;
  EXPECT_NEAR(MakeHumanTargetWeights(person).at("universal-male-young-averagemuscle-maxweight"), 0.5 * 2, 1e-12);
  EXPECT_NEAR(MakeHumanTargetWeights(person).at("universal-male-young-averagemuscle-averageweight"), 0.5 * -1, 1e-12);
}

TEST(MakeHumanPopulation, RandomAdultsLieOnTheSliders) {
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    const MakeHumanPerson person = RandomAdult(&random);
    for (double value : {person.male, person.muscle, person.height, person.proportions})
      EXPECT_TRUE(value >= 0 && value <= 1);
    EXPECT_TRUE(person.age >= 0.5 && person.age <= 0.95);
    EXPECT_TRUE(person.weight >= -0.1 && person.weight <= 1.8);
    EXPECT_NEAR(person.ancestry.sum(), 1, 1e-12);
    EXPECT_GE(person.ancestry.minCoeff(), 0);
  }
}

}  // namespace
}  // namespace bodyloom
