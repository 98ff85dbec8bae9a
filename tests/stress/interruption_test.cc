// SPDX-License-Identifier: Apache-2.0
// The command and a batch killed at a random moment: outputs are complete or absent, and a second run gives the same
// bytes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "data_tools/motion/track_io.h"
#include "tests/support/paths.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom::stress::interruption_test {
namespace {

/// Starts `bodyloom arguments...` and kills it (SIGKILL) after `milliseconds`. Returns whether it was still running.
/// The time counts from when `begun` holds, where it is given: how long a program takes to begin depends on what else
/// the machine does.
bool KillAfter(const std::vector<std::string>& arguments, int milliseconds, const std::function<bool()>& begun = {}) {
  const std::string command = CommandPath();
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_RDWR);
    dup2(nowhere, STDIN_FILENO);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    std::vector<char*> argv = {const_cast<char*>(command.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(command.c_str(), argv.data());
    _exit(127);
  }
  constexpr int kLongestBegin = 20000;  // half milliseconds
  for (int i = 0; begun && i < kLongestBegin && !begun(); ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(500));
    siginfo_t ended{};
    if (waitid(P_PID, child, &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == child) break;
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

TEST(Interruption, ATrackKilledAtARandomMomentIsWholeOrNotThereAndRunsAgain) {
  if (CommandPath().empty()) GTEST_SKIP() << "built without apps/: there is no command to kill";
  const ScratchFolder folder;
  const CommandResult synth = RunCommand(
      {"synth", "--motion", "demo", "--frames", "10", "--fps", "15", "--dense", "0", "--out", folder / "clip"});
  ASSERT_EQ(synth.exit_code, 0) << synth.err;
  const auto track = [&](const std::string& out) -> std::vector<std::string> {
    return {"track", "--detections", folder / "clip/observations.npz", "--cameras", folder / "clip/camera.json",
            "--out", folder / out};
  };
  const auto start = std::chrono::steady_clock::now();
  const CommandResult whole = RunCommand(track("whole.npz"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const int run_ms = static_cast<int>(
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - start).count());
  const std::string expected = FileBytes(folder / "whole.npz");
  std::mt19937 random(3);
  int killed = 0, absent = 0;
  constexpr int kKills = 8;
  for (int i = 0; i < kKills; ++i) {
    const std::string name = "killed" + std::to_string(i) + ".npz";
    // A random moment of each eighth: the runs that are killed may be faster than the one that was timed.
    const unsigned eighth = static_cast<unsigned>(run_ms + run_ms / 4) / kKills + 1;
    killed +=
        KillAfter(track(name), 1 + static_cast<int>(static_cast<unsigned>(i) * eighth + random() % eighth)) ? 1 : 0;
    const std::string bytes = FileBytes(folder / name);
    if (bytes.empty()) {
      ++absent;
    } else {
      EXPECT_EQ(bytes, expected) << "a partial or other file after a kill";
    }
    if (i == 0) {
      EXPECT_EQ(RunCommand(track(name)).exit_code, 0);
      EXPECT_EQ(FileBytes(folder / name), expected);
    }
  }
  EXPECT_GT(killed, 2);
  EXPECT_GT(absent, 1);
}

/// Contents of each clip's folder: the track's bytes, and the names of the other files (reports have times in them).
std::map<std::string, std::string> ClipsOf(const std::string& out) {
  std::map<std::string, std::string> clips;
  if (!std::filesystem::exists(out + "/clips")) return clips;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out + "/clips")) {
    if (entry.is_directory()) continue;
    const std::string path = entry.path().string();
    clips[entry.path().lexically_relative(out).string()] = path.ends_with(".npz") ? FileBytes(path) : "";
  }
  return clips;
}

TEST(Interruption, ABatchKilledAgainAndAgainEndsAsOneThatWasNot) {
  if (CommandPath().empty()) GTEST_SKIP() << "built without apps/: there is no command to kill";
  const ScratchFolder folder;
  const CommandResult synth = RunCommand(
      {"synth", "--motion", "demo", "--frames", "10", "--fps", "15", "--dense", "0", "--out", folder / "clip"});
  ASSERT_EQ(synth.exit_code, 0) << synth.err;
  constexpr int kClips = 6, kMaxKills = 40, kFilesOfAClip = 3;
  std::string manifest;
  for (int i = 0; i < kClips; ++i) {
    manifest += "{\"id\":\"c" + std::to_string(i) + "\",\"detections\":\"clip/observations.npz\"}\n";
  }
  std::ofstream(folder / "clips.jsonl") << manifest;
  const auto batch = [&](const std::string& out) -> std::vector<std::string> {
    return {"batch", "--manifest", folder / "clips.jsonl", "--cameras", folder / "clip/camera.json",
            "--out", folder / out};
  };
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(RunCommand(batch("whole")).exit_code, 0);
  const int run_ms = static_cast<int>(
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - start).count());
  const std::map<std::string, std::string> expected = ClipsOf(folder / "whole");
  ASSERT_EQ(expected.size(), size_t{kClips * kFilesOfAClip});
  std::mt19937 random(5);
  int killed = 0, left_at_work = 0;
  std::map<std::string, std::string> before;
  const std::string work = folder / "killed/.work";
  const auto names_at_work = [&] {
    std::set<std::string> names;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(work, ignored)) names.insert(entry.path().filename());
    return names;
  };
  for (int i = 0; i < kMaxKills && before.size() < expected.size(); ++i) {
    // Every other one while a clip is at work.
    const std::set<std::string> left = names_at_work();
    const auto is_at_work = [&] {
      const std::set<std::string> names = names_at_work();
      return !std::includes(left.begin(), left.end(), names.begin(), names.end());
    };
    if (i % 2 == 1) {
      killed += KillAfter(batch("killed"), static_cast<int>(random() % 4), is_at_work) ? 1 : 0;
    } else {
      killed += KillAfter(batch("killed"), static_cast<int>(1 + random() % unsigned(run_ms / 2 + 1))) ? 1 : 0;
    }
    left_at_work += names_at_work().empty() ? 0 : 1;
    const std::map<std::string, std::string> now = ClipsOf(folder / "killed");
    EXPECT_EQ(now.size() % kFilesOfAClip, 0u) << "a folder is there in part";
    for (const auto& [name, bytes] : now) EXPECT_EQ(bytes, expected.at(name)) << name;
    for (const auto& [name, bytes] : before) EXPECT_TRUE(now.contains(name)) << name << " was done, and is gone";
    before = now;
  }
  EXPECT_GT(killed, 2);
  EXPECT_GT(left_at_work, 0) << "no kill hit a clip at work";
  const CommandResult last = RunCommand(batch("killed"));
  EXPECT_EQ(last.exit_code, 0) << last.err;
  EXPECT_EQ(ClipsOf(folder / "killed"), expected);
  EXPECT_TRUE(std::filesystem::is_empty(work)) << "what killed processes left piles up";
  EXPECT_EQ(FileBytes(folder / "killed/clips.csv").find("failed"), std::string::npos);
  EXPECT_NE(FileBytes(folder / "killed/clips.csv").find("\nc5,done,"), std::string::npos);
}

}  // namespace
}  // namespace bodyloom::stress::interruption_test
