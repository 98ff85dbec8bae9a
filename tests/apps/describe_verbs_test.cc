// SPDX-License-Identifier: Apache-2.0
// `bodyloom describe` and `bodyloom texture` on a short clip that `bodyloom synth` makes once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/usage_error.h"
#include "data_tools/formats/npz.h"
#include "data_tools/video/image_file.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::describe_verbs_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kFrames = 14;

nlohmann::json JsonOf(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

class DescribeVerbs : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new ScratchFolder;
    const CommandResult made =
        RunCommand({"synth", "--motion", "demo", "--first", "60", "--frames", std::to_string(kFrames), "--out",
                    *shared_ / "clip", "--width", "320", "--height", "240", "--video"});
    ASSERT_EQ(made.exit_code, kExitOk) << made.err;
  }
  static void TearDownTestSuite() { delete shared_; }
  static std::string Track() { return *shared_ / "clip/truth.npz"; }
  static std::string Video() { return *shared_ / "clip/clip.mp4"; }

  void ExpectFailure(const std::vector<std::string>& arguments, int exit_code, const std::string& text,
                     const CommandOptions& options = {}) {
    const CommandResult result = RunCommand(arguments, options);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
    if (exit_code == kExitFailed) {
      EXPECT_EQ(result.NumErrorLines() - (result.err.find("describe ") == 0 || result.err.find("texture ") == 0), 1)
          << result.err;
    }
    EXPECT_TRUE(folder_.Entries().empty()) << "nothing is left behind";
  }

  static ScratchFolder* shared_;
  ScratchFolder folder_;
};
ScratchFolder* DescribeVerbs::shared_ = nullptr;

TEST_F(DescribeVerbs, DescribeWritesMapsHeaderPreviewAndReport) {
  const CommandResult result =
      RunCommand({"describe", "--track", Track(), "--out", folder_ / "d.npy", "--size", "64", "--past", "3", "--frame",
                  "body", "--velocity", "central", "--preview", folder_ / "d.png", "--json", folder_ / "run.json"});
  ASSERT_EQ(result.exit_code, kExitOk) << result.err;
  EXPECT_THAT(result.out, HasSubstr("14 frames x 12 channels x 64 x 64"));
  const NdArray maps = ReadNpy(folder_ / "d.npy");
  EXPECT_EQ(maps.shape, (std::vector<int64_t>{kFrames, 12, 64, 64}));
  const nlohmann::json header = JsonOf(folder_ / "d.json");
  EXPECT_EQ(header["frame"], "body");
  EXPECT_EQ(header["velocity"]["scheme"], "central");
  EXPECT_EQ(header["channels"].size(), 12U);
  EXPECT_EQ(header["timestamps"].size(), size_t{kFrames});
  EXPECT_EQ(JsonOf(folder_ / "run.json")["velocity_maps_baked"], kFrames);
  EXPECT_GT(ReadImage(folder_ / "d.png").height, 500);
}

TEST_F(DescribeVerbs, DescribeInHalvesOfSomeFramesAndChannels) {
  const CommandResult result =
      RunCommand({"describe", "--track", Track(), "--out", folder_ / "d.npy", "--size", "32", "--channels", "normal",
                  "--dtype", "f16", "--every", "5", "--seen-only", "--frame", "world", "--threads", "2"});
  ASSERT_EQ(result.exit_code, kExitOk) << result.err;
  const NdArray maps = ReadNpy(folder_ / "d.npy");
  EXPECT_EQ(maps.dtype, DType::kF16);
  EXPECT_EQ(maps.shape, (std::vector<int64_t>{3, 3, 32, 32}));
  EXPECT_EQ(JsonOf(folder_ / "d.json")["camera_from_world_rotation"][1][1], -1);
}

TEST_F(DescribeVerbs, DescribeRefusesInOneLine) {
  const std::string out = folder_ / "d.npy";
  ExpectFailure({"describe", "--track", Track(), "--out", folder_ / "d.bin"}, kExitUsage, ".npy");
  ExpectFailure({"describe", "--track", Track(), "--out", out, "--velocity", "magic"}, kExitUsage, "--velocity");
  ExpectFailure({"describe", "--track", Track(), "--out", out, "--size", "0"}, kExitUsage, "--size");
  ExpectFailure({"describe", "--track", Track(), "--out", out, "--past", "0", "--channels", "velocity"}, kExitUsage,
                "neither");
  ExpectFailure({"describe", "--track", Track(), "--out", out, "--cameras", Track()}, kExitUsage, "--frame world");
  ExpectFailure({"describe", "--track", Track(), "--out", Track() + "/x.npy"}, kExitFailed, "cannot be written");
  ExpectFailure({"describe", "--track", folder_ / "absent", "--out", out}, kExitFailed, "No such file");
  ExpectFailure({"describe", "--track", Video(), "--out", out}, kExitFailed, Video());
  // A disk that fills up: no file, no temporary.
  ExpectFailure({"describe", "--track", Track(), "--out", out}, kExitFailed, out,
                {.file_size_limit = 1 << 20, .interrupt_on = "", .work_folder = ""});
}

TEST_F(DescribeVerbs, TextureIsTakenFromTheVideo) {
  const CommandResult result =
      RunCommand({"texture", "--track", Track(), "--video", Video(), "--out", folder_ / "t.png", "--size", "128",
                  "--every", "3", "--fill", "--confidence", folder_ / "c.png", "--json", folder_ / "run.json"});
  ASSERT_EQ(result.exit_code, kExitOk) << result.err;
  const Image texture = ReadImage(folder_ / "t.png"), confidence = ReadImage(folder_ / "c.png");
  EXPECT_EQ(texture.width, 128);
  const nlohmann::json report = JsonOf(folder_ / "run.json");
  EXPECT_EQ(report["frames_used"], 5);
  EXPECT_GT(report["texels_seen"].get<int>(), report["texels"].get<int>() / 4);
  int seen = 0, coloured = 0;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      seen += confidence.at(x, y).red > 0;
      coloured += texture.at(x, y).red + texture.at(x, y).green > 0;
    }
  }
  EXPECT_GE(coloured, report["texels"].get<int>());  // filled, gutter included
  EXPECT_LT(seen, coloured);
}

TEST_F(DescribeVerbs, TextureSaysWhenVideoAndTrackDiffer) {
  // Fewer images than the track has frames.
  fs::create_directory(folder_ / "images");
  for (int i = 0; i < 4; ++i)
    WriteImage(folder_ / ("images/" + std::to_string(i) + ".png"), Image(320, 240, {9, 9, 9}));
  const CommandResult result = RunCommand({"texture", "--track", Track(), "--video", folder_ / "images", "--out",
                                           folder_ / "t.png", "--size", "64", "--fill-with", "laplace", "--fill"});
  EXPECT_EQ(result.exit_code, kExitOk) << result.err;
  EXPECT_THAT(result.out, HasSubstr("10 frames of the track lie beyond the end of the video"));
  for (int i = 0; i < 4; ++i) WriteImage(folder_ / ("images/" + std::to_string(i) + ".png"), Image(300, 300));
  const CommandResult refused =
      RunCommand({"texture", "--track", Track(), "--video", folder_ / "images", "--out", folder_ / "u.png"});
  EXPECT_EQ(refused.exit_code, kExitFailed);
  EXPECT_THAT(refused.err, HasSubstr("300x300"));
  EXPECT_FALSE(fs::exists(folder_ / "u.png"));
}

}  // namespace
}  // namespace bodyloom::describe_verbs_test
