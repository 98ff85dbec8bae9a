// SPDX-License-Identifier: Apache-2.0
// `bodyloom batch` as used by scripts and schedulers: output, table, exit codes, signals, limits, two processes at
// once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <thread>

#include "apps/usage_error.h"
#include "data_tools/formats/atomic_file.h"
#include "pipelines/batch/manifest.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom::batch_verb_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::vector<nlohmann::json> Lines(const std::string& text) {
  std::vector<nlohmann::json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

/// The status told of each clip; each is told of once.
std::map<std::string, std::string> Statuses(const CommandResult& result) {
  std::map<std::string, std::string> statuses;
  for (const nlohmann::json& line : Lines(result.out)) {
    EXPECT_TRUE(statuses.emplace(line["id"], line["status"]).second) << line;
  }
  return statuses;
}

/// A clip of `synth`, cut into several by name: the same joints, so that a clip costs little to make.
class BatchVerb : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    world_ = std::make_unique<ScratchFolder>();
    const CommandResult made = RunCommand(
        {"synth", "--motion", "demo", "--frames", "8", "--fps", "15", "--dense", "0", "--out", *world_ / "clip"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  static void TearDownTestSuite() { world_.reset(); }

  BatchVerb() {
    fs::copy(*world_ / "clip/observations.npz", folder_ / "o.npz");
    fs::copy(*world_ / "clip/camera.json", folder_ / "camera.json");
  }
  [[nodiscard]] static std::string Clip(const std::string& id, const std::string& more = "") {
    return "{\"id\":\"" + id + "\",\"detections\":\"o.npz\"" + (more.empty() ? "" : "," + more) + "}\n";
  }
  void WriteManifest(const std::string& text) const { WriteFileAtomically(folder_ / "clips.jsonl", text); }
  [[nodiscard]] CommandResult Batch(std::vector<std::string> more = {}, const CommandOptions& options = {}) const {
    std::vector<std::string> arguments = {"batch",         "--manifest", folder_ / "clips.jsonl", "--out",
                                          folder_ / "out", "--cameras",  folder_ / "camera.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments, options);
  }
  static std::unique_ptr<ScratchFolder> world_;
  ScratchFolder folder_;
};

std::unique_ptr<ScratchFolder> BatchVerb::world_;

TEST_F(BatchVerb, TracksAsTrackDoesAndThenSkips) {
  WriteManifest(Clip("a") + Clip("b", "\"no-ground\":true") + Clip("c", "\"no-ground\":false"));
  const CommandResult first = Batch({"--jobs", "2"});
  EXPECT_EQ(first.exit_code, kExitOk) << first.err;
  EXPECT_EQ(Statuses(first), (std::map<std::string, std::string>{{"a", "done"}, {"b", "done"}, {"c", "done"}}));
  EXPECT_THAT(first.err, HasSubstr("3 done, table: " + (folder_ / "out/clips.csv")));
  const std::vector<std::string> input = {"--detections", folder_ / "o.npz", "--cameras", folder_ / "camera.json"};
  for (const auto& [id, option] : {std::pair("a", ""), {"b", "--no-ground"}, {"c", ""}}) {
    std::vector<std::string> track = {"track", "--out", folder_ / "alone.npz"};
    track.insert(track.end(), input.begin(), input.end());
    if (*option != '\0') track.push_back(option);
    ASSERT_EQ(RunCommand(track).exit_code, 0);
    EXPECT_EQ(FileBytes(folder_ / ("out/clips/" + std::string(id) + "/track.npz")), FileBytes(folder_ / "alone.npz"));
  }
  const CommandResult second = Batch({"--threads", "1"});
  EXPECT_EQ(second.exit_code, kExitOk);
  EXPECT_EQ(Statuses(second),
            (std::map<std::string, std::string>{{"a", "skipped"}, {"b", "skipped"}, {"c", "skipped"}}));
  EXPECT_EQ(Statuses(Batch({"--stature", "1.9"}))["a"], "done") << "an option for all clips";
}

TEST_F(BatchVerb, ShardsShareTheClipsAndTheLastWritesTheTable) {
  WriteManifest(Clip("a") + Clip("b") + Clip("c") + Clip("d") + Clip("e"));
  std::set<std::string> told;
  for (const char* shard : {"1/2", "0/2"}) {
    EXPECT_FALSE(fs::exists(folder_ / "out/clips.csv"));
    const CommandResult result = Batch({"--shard", shard});
    EXPECT_EQ(result.exit_code, kExitOk) << result.err;
    EXPECT_THAT(result.err, HasSubstr(told.empty() ? "2 done, no table yet" : "3 done, table: "));
    for (const auto& [id, status] : Statuses(result)) EXPECT_TRUE(told.insert(id).second) << id;
  }
  EXPECT_EQ(told.size(), 5u);
  const std::string table = FileBytes(folder_ / "out/clips.csv");
  for (const std::string& id : told) EXPECT_THAT(table, HasSubstr("\n" + id + ",done,"));
}

TEST_F(BatchVerb, ExitCodesTellOutcomesApart) {
  std::string joints;
  for (int k = 0; k < 17; ++k) joints += std::string(k > 0 ? "," : "") + "0,0,0";
  WriteFileAtomically(folder_ / "empty.json",
                      R"([{"image_id":0,"category_id":1,"keypoints":[)" + joints + R"(],"score":0.9}])");
  const std::string empty = "{\"id\":\"empty\",\"detections\":\"empty.json\"}\n";
  const std::string bad = "{\"id\":\"bad\",\"detections\":\"absent.json\"}\n";
  WriteManifest(Clip("a") + empty);
  CommandResult result = Batch();
  EXPECT_EQ(result.exit_code, kExitNoPersonFound) << result.err;
  EXPECT_EQ(Statuses(result), (std::map<std::string, std::string>{{"a", "done"}, {"empty", "nothing_to_track"}}));
  EXPECT_EQ(Batch().exit_code, kExitNoPersonFound) << "the same once it is stored";
  WriteManifest(bad + empty + Clip("a"));
  result = Batch();
  EXPECT_EQ(result.exit_code, kExitFailed) << result.err;
  EXPECT_EQ(Statuses(result)["a"], "skipped");
  EXPECT_EQ(Statuses(result)["bad"], "failed");
  for (const nlohmann::json& line : Lines(result.out)) {
    if (line["id"] != "bad") continue;
    EXPECT_THAT(line["reason"].get<std::string>(), HasSubstr("absent.json: "));
    EXPECT_EQ(line["verb"], "track");
    EXPECT_EQ(line, nlohmann::json::parse(FileBytes(folder_ / "out/failed/bad.json")));
    EXPECT_THAT(FileBytes(folder_ / "out/clips.csv"),
                HasSubstr("reason\nbad,failed,,,0,0,0,0,0,0.00,\"" + folder_.path()));
  }
}

TEST_F(BatchVerb, AManifestThatCannotBeUsedIsRefusedBeforeAnythingIsDone) {
  for (const auto& [line, expected] :
       {std::pair<std::string, std::string>{"garbage", "line 2: byte 1: "},
        {Clip("a"), "line 2: id 'a' is that of line 1"},
        {Clip("b", "\"fpz\":30"), "line 2: 'fpz' is no option of track"},
        {Clip("b", "\"people\":2"), "line 2: 'people' is no option of track"},
        {Clip("b", "\"fps\":-3"), "line 2: --fps"},
        {Clip("b", "\"no-ground\":7"), "line 2: no-ground: found 7, expected true or false"},
        {Clip("b", "\"report\":\"x.html\""), "line 2: report: found x.html, expected true or false"},
        {Clip("b", "\"out\":\"x.npz\""), "line 2: 'out' is no option of a clip"},
        {Clip("b", "\"camera\":\"pinhole\",\"focal\":500"), "line 2: --cameras and --focal both"}}) {
    WriteManifest(Clip("a") + line);
    const CommandResult result = Batch();
    EXPECT_EQ(result.exit_code, kExitFailed) << line;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.NumErrorLines(), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("clips.jsonl: " + expected));
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
}

TEST(BatchSettings, EveryOptionThatNamesAFileToReadIsTakenForAPath) {
  const std::set<std::string> written = {"out", "overlay", "json", "report", "rig-out", "camera-path-out"};
  const std::regex option("--([a-z-]+) (FILE|PATH|DIR|[A-Z]+)?");
  int paths = 0;
  for (const char* verb : {"track", "run"}) {
    const std::string help = RunCommand({verb, "--help"}).out;
    for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at) {
      const std::string name = (*at)[1], type = (*at)[2];
      // In the list of options, where a line begins with them, and not in examples.
      if (written.contains(name) || at->prefix().str().find_last_not_of(' ') == std::string::npos) continue;
      if (at->prefix().str()[at->prefix().str().find_last_not_of(' ')] != '\n') continue;
      const bool is_path = type == "FILE" || type == "PATH" || type == "DIR";
      EXPECT_EQ(IsPathSetting(name, "x"), is_path) << verb << " --" << name << " " << type;
      paths += is_path ? 1 : 0;
    }
  }
  EXPECT_GT(paths, 15);
}

TEST_F(BatchVerb, WrongUsageIsToldApart) {
  WriteManifest(Clip("a"));
  EXPECT_EQ(Batch({"--shard", "2/2"}).exit_code, kExitUsage);
  EXPECT_EQ(Batch({"--jobs", "0"}).exit_code, kExitUsage);
  EXPECT_EQ(Batch({"--no-such-option"}).exit_code, kExitUsage);
  EXPECT_EQ(RunCommand({"batch", "--out", folder_ / "out"}).exit_code, kExitUsage);
}

TEST_F(BatchVerb, QuietLeavesTheLinesAlone) {
  WriteManifest(Clip("a") + Clip("b"));
  const CommandResult result = Batch({"--quiet"});
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(Statuses(result).size(), 2u);
}

TEST_F(BatchVerb, SignalsEndItAndWhatIsDoneStays) {
  std::string manifest;
  for (int i = 0; i < 12; ++i) manifest += Clip("c" + std::to_string(i));
  WriteManifest(manifest);
  for (const int signal : {SIGTERM, SIGINT}) {
    fs::remove_all(folder_ / "out");
    CommandOptions options;
    options.interrupt_on = "3 of 12";
    options.signal = signal;
    const CommandResult cut = Batch({"--jobs", "1"}, options);
    EXPECT_EQ(cut.exit_code, kExitInterrupted) << cut.err;
    EXPECT_THAT(cut.err, HasSubstr("interrupted"));
    const std::map<std::string, std::string> statuses = Statuses(cut);
    EXPECT_GE(statuses.size(), 3u);
    EXPECT_LT(statuses.size(), 12u);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out/clips"), {}), static_cast<long>(statuses.size()));
    EXPECT_TRUE(fs::is_empty(folder_ / "out/.work"));
    const CommandResult again = Batch();
    EXPECT_EQ(again.exit_code, kExitOk) << again.err;
    EXPECT_EQ(Statuses(again).size(), 12u);
    for (const auto& [id, status] : Statuses(again)) {
      EXPECT_EQ(status, statuses.contains(id) ? "skipped" : "done") << id;
    }
  }
}

TEST_F(BatchVerb, AFullDiskIsOneLineAndLeavesNothingHalf) {
  WriteManifest(Clip("a") + Clip("b"));
  CommandOptions options;
  options.file_size_limit = 3000;  // a track is larger
  for (const char* jobs : {"1", "2"}) {
    const CommandResult full = Batch({"--jobs", jobs, "--quiet"}, options);
    EXPECT_EQ(full.exit_code, kExitFailed) << full.err;
    EXPECT_EQ(full.out, "");
    EXPECT_EQ(full.NumErrorLines(), 1) << full.err;
    EXPECT_THAT(full.err, HasSubstr("File too large"));
    EXPECT_FALSE(fs::exists(folder_ / "out/clips"));
    EXPECT_FALSE(fs::exists(folder_ / "out/failed")) << "it is not the clip's fault";
    EXPECT_TRUE(fs::is_empty(folder_ / "out/.work"));
  }
  EXPECT_EQ(Batch().exit_code, kExitOk);
}

TEST_F(BatchVerb, TwoOnOneShardAtOnceLeaveItWhole) {
  constexpr int kClips = 10;
  std::string manifest;
  for (int i = 0; i < kClips; ++i) manifest += Clip("c" + std::to_string(i));
  WriteManifest(manifest);
  CommandResult results[2];
  {
    std::vector<std::jthread> both;
    for (CommandResult& result : results) both.emplace_back([&] { result = Batch({"--jobs", "1"}); });
  }
  for (const CommandResult& result : results) {
    EXPECT_EQ(result.exit_code, kExitOk) << result.err;
    EXPECT_EQ(Statuses(result).size(), size_t{kClips});
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out/clips"), {}), kClips);
  const std::string track = FileBytes(folder_ / "out/clips/c0/track.npz");
  for (int i = 0; i < kClips; ++i) {
    EXPECT_EQ(FileBytes(folder_ / ("out/clips/c" + std::to_string(i) + "/track.npz")), track) << "the same clip";
  }
  const CommandResult again = Batch();
  EXPECT_EQ(again.exit_code, kExitOk);
  for (const auto& [id, status] : Statuses(again)) EXPECT_EQ(status, "skipped") << id;
  EXPECT_TRUE(fs::is_empty(folder_ / "out/.work"));
}

}  // namespace
}  // namespace bodyloom::batch_verb_test
