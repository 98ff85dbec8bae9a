// SPDX-License-Identifier: Apache-2.0
// Bad input, full disks and interruptions: one clear line, the right exit code, no half-written output.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "apps/usage_error.h"
#include "data_tools/formats/npz.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::bad_input_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Fails with one line on stderr that holds all of `texts`.
void ExpectFailure(const std::vector<std::string>& arguments, const std::vector<std::string>& texts,
                   const CommandOptions& options = {}) {
  const CommandResult result = RunCommand(arguments, options);
  EXPECT_EQ(result.exit_code, kExitFailed) << result.err;
  EXPECT_EQ(result.NumErrorLines(), 1) << result.err;
  for (const std::string& text : texts) {
    EXPECT_THAT(result.err, HasSubstr(text));
  }
}

void ExpectUsageError(const std::vector<std::string>& arguments, const std::string& text) {
  const CommandResult result = RunCommand(arguments);
  EXPECT_EQ(result.exit_code, kExitUsage) << result.err;
  EXPECT_THAT(result.err, HasSubstr(text));
  EXPECT_EQ(result.out, "");
}

class BadInput : public ::testing::Test {
 protected:
  void Write(const std::string& name, const std::string& content) const { std::ofstream(folder_ / name) << content; }
  /// A COCO result list of one frame with 17 landmarks at the given place.
  void WriteDetections(const std::string& name, int num_frames = 1) const {
    std::string json = "[";
    for (int t = 0; t < num_frames; ++t) {
      json +=
          (t > 0 ? "," : "") + std::string("{\"image_id\":") + std::to_string(t) + ",\"category_id\":1,\"keypoints\":[";
      for (int k = 0; k < 17; ++k) {
        json += (k > 0 ? "," : "") + std::to_string(100 + 3 * k) + "," + std::to_string(80 + 7 * k) + ",0.9";
      }
      json += "],\"score\":0.9}";
    }
    Write(name, json + "]");
  }
  ScratchFolder folder_;
};

TEST_F(BadInput, MissingFilesAreNamed) {
  const std::string absent = folder_ / "absent", out = folder_ / "out.npz";
  WriteDetections("d.json");
  ExpectFailure({"track", "--detections", absent, "--out", out}, {absent + ": No such file", "(detections)"});
  for (const std::string option : {"--cameras", "--video", "--body", "--init", "--prior"}) {
    ExpectFailure(
        {"track", "--detections", folder_ / "d.json", "--image-size", "320x240", option, absent, "--out", out},
        {absent + ": No such file"});
  }
  ExpectFailure({"evaluate", "--track", absent, "--truth", absent}, {absent + ": No such file", "(track)"});
  ExpectFailure({"export", "--track", absent, "--what", "bvh", "--out", out}, {absent + ": No such file"});
  ExpectFailure({"synth", "--motion", absent, "--out", folder_ / "clip"}, {absent + ": No such file"});
  ExpectFailure({"body", "info", absent}, {absent + ": No such file"});
  ExpectFailure({"body", "convert", "--body", absent, "--out", out}, {absent + ": No such file"});
  EXPECT_THAT(folder_.Entries(), ElementsAre("d.json"));
}

TEST_F(BadInput, GarbageIsNamedWhateverItPretendsToBe) {
  for (const auto& [name, content] :
       std::vector<std::pair<std::string, std::string>>{{"empty", ""},
                                                        {"noise.bin", std::string("\x01\x93\xff\x00 garbage", 12)},
                                                        {"cut.npz", std::string("PK\x03\x04\x14", 5)},
                                                        {"cut.json", "[{\"image_id\": 1, \"keypoints\": [1, 2"},
                                                        {"deep.json", std::string(5000, '[')},
                                                        {"evil.pkl", "cos\nsystem\n(S'touch hacked'\ntR."}}) {
    Write(name, content);
    const std::string path = folder_ / name;
    SCOPED_TRACE(name);
    ExpectFailure({"track", "--detections", path, "--image-size", "320x240", "--out", folder_ / "o.npz"}, {path});
    ExpectFailure({"body", "info", path}, {path});
    ExpectFailure({"export", "--track", path, "--what", "bvh", "--out", folder_ / "o.bvh"}, {path});
    ExpectFailure({"evaluate", "--track", path, "--truth", path}, {path});
    ExpectFailure({"synth", "--motion", path, "--out", folder_ / "clip"}, {path});
    EXPECT_FALSE(fs::exists(folder_ / "o.npz"));
    EXPECT_FALSE(fs::exists(folder_ / "hacked"));
  }
}

TEST_F(BadInput, WhatIsMissingIsSaidWithTheRemedy) {
  WriteDetections("d.json");
  ExpectFailure({"track", "--detections", folder_ / "d.json", "--out", folder_ / "o.npz"},
                {folder_ / "d.json", "--image-size"});
  ExpectFailure({"track", "--detections", folder_ / "d.json", "--image-size", "320x240", "--person", "3", "--out",
                 folder_ / "o.npz"},
                {folder_ / "d.json", "person"});
  Write("nobody.json", R"([{"version":1.3,"people":[]},{"version":1.3,"people":[]}])");
  ExpectFailure(
      {"track", "--detections", folder_ / "nobody.json", "--image-size", "320x240", "--out", folder_ / "o.npz"},
      {folder_ / "nobody.json"});
}

TEST_F(BadInput, ImageSizeThatContradictsTheDetectionsIsSaid) {
  WriteDetections("d.json");
  ExpectFailure({"track", "--detections", folder_ / "d.json", "--image-size", "64x48", "--out", folder_ / "o.npz"},
                {folder_ / "d.json", "64x48"});
}

TEST_F(BadInput, OptionsThatContradictEachOtherAreUsageErrors) {
  WriteDetections("d.json");
  const std::string d = folder_ / "d.json", o = folder_ / "o.npz";
  ExpectUsageError({"track", "--out", o}, "--video is required");
  ExpectUsageError({"track", "--detections", d}, "--out is required");
  ExpectUsageError({"track", "--detections", d, "--out", o, "--camera", "pinhole"}, "--cameras FILE or --focal");
  ExpectUsageError({"track", "--detections", d, "--out", o, "--camera", "fisheye"}, "fisheye");
  ExpectUsageError({"track", "--detections", d, "--out", o, "--threads", "-1"}, "--threads");
  ExpectUsageError({"track", "--detections", d, "--out", o, "--image-size", "large"}, "WIDTHxHEIGHT");
  ExpectUsageError({"track", "--detections", d, "--out", d}, "both to read and to write");
  ExpectUsageError({"track", "--detections", d, "--out", o, "--json", o}, "twice to write");
  ExpectUsageError({"track", "--detections", d, "--out", o, "--overlay", folder_ / "o.avi"}, ".mp4");
  ExpectUsageError({"track", "--detections", d, "--out", o, "--side-view"}, "--overlay");
  ExpectUsageError({"export", "--track", d, "--what", "usd", "--out", o}, "usd");
  ExpectUsageError({"export", "--track", d, "--track", d, "--what", "bvh", "--out", o}, "holds one person");
  ExpectUsageError({"export", "--track", d, "--what", "glb", "--axes", "world", "--out", o}, "axes of its own");
  ExpectUsageError({"export", "--track", d, "--what", "glb", "--rig", "mixamo", "--out", o}, "--rig");
  ExpectUsageError({"export", "--track", d, "--what", "bvh", "--texture", d, "--out", o}, "--texture");
  ExpectUsageError({"export", "--track", d, "--what", "angles", "--out", folder_ / "o.txt"}, ".csv or .mot");
  ExpectUsageError({"export", "--track", d, "--what", "bvh", "--events", o, "--out", folder_ / "o.bvh"}, "--events");
  ExpectUsageError({"export", "--track", d, "--what", "angles", "--events", d, "--out", folder_ / "o.csv"}, "both");
  ExpectUsageError({"body"}, "body: no verb");
}

TEST_F(BadInput, FaultsThatArePassedOverAreSaid) {
  const auto frame = [](int t) {
    std::string numbers;
    for (int k = 0; k < 25; ++k) {
      numbers += (k > 0 ? "," : "") + std::to_string(100 + t + 3 * k) + "," + std::to_string(50 + 7 * k) + ",0.9";
    }
    return R"({"people":[{"pose_keypoints_2d":[)" + numbers + "]}]}";
  };
  fs::create_directory(folder_ / "frames");
  for (int t = 0; t < 5; ++t) Write("frames/f_" + std::to_string(t) + ".json", t == 3 ? "{\"peo" : frame(t));
  const CommandResult planned = RunCommand({"track", "--plan", "--detections", folder_ / "frames", "--convention",
                                            "body25", "--image-size", "640x480", "--out", folder_ / "o.npz"});
  EXPECT_EQ(planned.exit_code, kExitOk) << planned.err;
  EXPECT_THAT(planned.out, HasSubstr("1 of 5 files are empty, cut or no JSON and count as frames without detections, "
                                     "the first f_3.json"));

  ASSERT_EQ(RunCommand({"synth", "--motion", "demo", "--frames", "3", "--fps", "30", "--dense", "0", "--out",
                        folder_ / "clip"})
                .exit_code,
            kExitOk);
  ASSERT_EQ(RunCommand({"export", "--track", folder_ / "clip/truth.npz", "--what", "bvh", "--out", folder_ / "m.bvh"})
                .exit_code,
            kExitOk);
  std::ifstream file(folder_ / "m.bvh");
  std::string bvh{std::istreambuf_iterator<char>(file), {}};
  const size_t at = bvh.find("Frames: 3");
  ASSERT_NE(at, std::string::npos);
  Write("n.bvh", bvh.replace(at, 9, "Frames:7"));
  const CommandResult made =
      RunCommand({"synth", "--motion", folder_ / "n.bvh", "--dense", "0", "--out", folder_ / "again"});
  EXPECT_EQ(made.exit_code, kExitOk) << made.err;
  EXPECT_THAT(made.out, HasSubstr("n.bvh: 3 whole frames, the header says 7"));

  // AMASS has 16 shape components, the built-in body 10.
  ASSERT_EQ(RunCommand({"export", "--track", folder_ / "clip/truth.npz", "--what", "smplx", "--out", folder_ / "s.npz"})
                .exit_code,
            kExitOk);
  const CommandResult shaped =
      RunCommand({"synth", "--motion", folder_ / "s.npz", "--dense", "0", "--out", folder_ / "shaped"});
  EXPECT_EQ(shaped.exit_code, kExitOk) << shaped.err;
  EXPECT_THAT(shaped.out, HasSubstr("s.npz: of 16 shape components the first 10 are taken"));
}

TEST_F(BadInput, UnwritableOutputIsSaidBeforeAnythingIsRead) {
  Write("garbage", "not even looked at");
  const std::string out = folder_ / "absent/out.npz";
  ExpectFailure({"track", "--detections", folder_ / "garbage", "--out", out}, {out, "cannot be written"});
  ExpectFailure({"body", "convert", "--body", folder_ / "garbage", "--out", out}, {out, "cannot be written"});
  ExpectFailure({"export", "--track", folder_ / "garbage", "--what", "bvh", "--out", out}, {out, "cannot be written"});
  ExpectFailure({"synth", "--motion", folder_ / "garbage", "--out", folder_ / "garbage"}, {"cannot be made a folder"});
  ExpectFailure({"demo", "--out", "/proc/demo"}, {"/proc/demo"});
}

TEST_F(BadInput, AFullDiskLeavesNothingBehind) {
  CommandOptions options;
  options.file_size_limit = 20000;
  ExpectFailure({"body", "make", "--out", folder_ / "body.npz"}, {folder_ / "body.npz"}, options);
  EXPECT_THAT(folder_.Entries(), IsEmpty());
}

TEST_F(BadInput, AFullDiskLeavesTheOldFileAlone) {
  Write("body.npz", "old");
  CommandOptions options;
  options.file_size_limit = 20000;
  ExpectFailure({"body", "make", "--out", folder_ / "body.npz"}, {folder_ / "body.npz"}, options);
  EXPECT_THAT(folder_.Entries(), ElementsAre("body.npz"));
  EXPECT_EQ(fs::file_size(folder_ / "body.npz"), 3u);
}

TEST_F(BadInput, AnInterruptedTrackLeavesNothingBehind) {
  WriteDetections("d.json", 2000);
  CommandOptions options;
  options.interrupt_on = "% fit";
  const CommandResult result = RunCommand({"track", "--detections", folder_ / "d.json", "--image-size", "320x240",
                                           "--out", folder_ / "o.npz", "--json", folder_ / "o.json"},
                                          options);
  EXPECT_EQ(result.exit_code, kExitInterrupted) << result.err;
  EXPECT_THAT(result.err, HasSubstr("bodyloom: interrupted"));
  EXPECT_THAT(folder_.Entries(), ElementsAre("d.json"));
}

TEST_F(BadInput, AnInterruptedVideoLeavesNoHalfVideo) {
  CommandOptions options;
  options.interrupt_on = "% clip";
  const CommandResult result = RunCommand({"synth", "--motion", "demo", "--video", "--out", folder_ / "clip"}, options);
  EXPECT_EQ(result.exit_code, kExitInterrupted) << result.err;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "clip")) {
    EXPECT_THAT(entry.path().filename().string(), ::testing::AnyOf("observations.npz", "truth.npz", "camera.json"));
  }
}

}  // namespace
}  // namespace bodyloom::bad_input_test
