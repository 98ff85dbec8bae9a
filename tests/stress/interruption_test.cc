// SPDX-License-Identifier: Apache-2.0
// The command killed at a random moment: its output is whole or not there, and running it again gives the same bytes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iterator>
#include <random>
#include <thread>

#include "bodyloom/data_tools/motion/track_io.h"
#include "tests/support/paths.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom::stress {
namespace {

/// Starts `bodyloom arguments...` and kills it (SIGKILL) after `milliseconds`. Returns whether it was still running.
bool KillAfter(const std::vector<std::string>& arguments, int milliseconds) {
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

}  // namespace
}  // namespace bodyloom::stress
