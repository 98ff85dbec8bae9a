// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/work_place.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <vector>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Makes the file look untouched for that long.
void Age(const std::string& path, int seconds) {
  const timespec time = {::time(nullptr) - seconds, 0};
  const timespec times[2] = {time, time};
  ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
}

class WorkPlaceTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string Root() const { return folder_ / ".work"; }
  [[nodiscard]] std::string Lock() const { return folder_ / ".work/a/lock"; }
  [[nodiscard]] bool CanBeTaken() const {
    try {
      const WorkPlace place(Root(), "a");
      return true;
    } catch (const PlaceTaken&) {
      return false;
    }
  }
  /// A lock of the holder as it is, with one entry exchanged.
  void WriteLock(const std::string& key, const nlohmann::json& value) const {
    nlohmann::json lock;
    {
      const WorkPlace place(Root(), "b");
      lock = nlohmann::json::parse(FileBytes(folder_ / ".work/b/lock"));
    }
    lock["token"] = "other";
    lock[key] = value;
    fs::create_directories(folder_ / ".work/a/other");
    WriteFileAtomically(folder_ / ".work/a/other/half.npz", "half");
    WriteFileAtomically(Lock(), lock.dump() + "\n");
  }
  ScratchFolder folder_;
};

TEST_F(WorkPlaceTest, OneHolderAtATimeAndNothingLeft) {
  {
    const WorkPlace place(Root(), "a");
    EXPECT_TRUE(fs::is_empty(place.folder()));
    EXPECT_FALSE(CanBeTaken());
    const WorkPlace other(Root(), "a.b");
    EXPECT_NE(other.folder(), place.folder());
    WriteFileAtomically(place.folder() + "/half.npz", "half");
  }
  EXPECT_THAT(folder_.Entries(), IsEmpty());
  EXPECT_TRUE(CanBeTaken());
}

TEST_F(WorkPlaceTest, TheRefusalNamesTheHolder) {
  const WorkPlace place(Root(), "a");
  try {
    const WorkPlace other(Root(), "a");
    ADD_FAILURE();
  } catch (const PlaceTaken& taken) {
    EXPECT_THAT(taken.what(), HasSubstr("process " + std::to_string(getpid()) + " on "));
  }
}

TEST_F(WorkPlaceTest, AFolderIsMovedAsAWholeInPlaceOfAnOlderOne) {
  for (const char* text : {"first", "second"}) {
    WorkPlace place(Root(), "a");
    WriteFileAtomically(place.folder() + "/" + text, text);
    place.MoveFolderTo(folder_ / "clips/a");
    EXPECT_EQ(FileBytes(folder_ / ("clips/a/" + std::string(text))), text);
  }
  EXPECT_FALSE(fs::exists(folder_ / "clips/a/first"));
  EXPECT_THAT(folder_.Entries(), ElementsAre("clips"));
}

TEST_F(WorkPlaceTest, AKilledHoldersPlaceIsTakenOverAtOnceAndCleared) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const WorkPlace place(Root(), "a");
    WriteFileAtomically(place.folder() + "/half.npz", "half");
    raise(SIGKILL);
  }
  int status = 0;
  while (!fs::exists(Lock())) std::this_thread::yield();
  waitid(P_PID, static_cast<id_t>(child), nullptr, WEXITED | WNOWAIT);
  EXPECT_TRUE(fs::exists(Lock()));
  EXPECT_TRUE(CanBeTaken()) << "of a process that has ended and was not waited for";
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_THAT(folder_.Entries(), IsEmpty());
}

TEST_F(WorkPlaceTest, PlacesOfTheDeadAreClearedAndTheRootWithThem) {
  WriteLock("process", 0x7ffffff0);
  fs::create_directory(folder_ / ".work/c");         // killed before its lock, or after it
  fs::create_directories(folder_ / ".work/d/dead");  // killed between the lock that it took away and its own
  WriteFileAtomically(folder_ / ".work/d/dead/half.npz", "half");
  RemoveStalePlaces(Root());
  EXPECT_THAT(folder_.Entries(), IsEmpty());
  RemoveStalePlaces(Root());  // nothing there
}

TEST_F(WorkPlaceTest, PlacesOfTheLivingAreNotCleared) {
  {
    const WorkPlace place(Root(), "a");
    WriteFileAtomically(place.folder() + "/half.npz", "half");
    RemoveStalePlaces(Root());
    EXPECT_EQ(FileBytes(place.folder() + "/half.npz"), "half");
  }
  WriteLock("machine", "another");
  RemoveStalePlaces(Root());
  EXPECT_EQ(FileBytes(folder_ / ".work/a/other/half.npz"), "half");
}

TEST_F(WorkPlaceTest, AProcessNumberUsedAnewHoldsNothing) {
  WriteLock("start", "1");
  EXPECT_TRUE(CanBeTaken());
  EXPECT_THAT(folder_.Entries(), IsEmpty());
}

TEST_F(WorkPlaceTest, WhoWasKilledWhileTakingAStaleLockAwayIsNoObstacle) {
  WriteLock("process", 0x7ffffff0);
  WriteFileAtomically(Lock() + ".stale", FileBytes(Lock()));
  EXPECT_TRUE(CanBeTaken());
  EXPECT_THAT(folder_.Entries(), IsEmpty());
  WriteLock("process", 0x7ffffff0);
  WriteFileAtomically(Lock() + ".stale", "");  // of whom nobody knows
  EXPECT_FALSE(CanBeTaken());
  Age(Lock() + ".stale", WorkPlace::kStaleSeconds + 30);
  EXPECT_TRUE(CanBeTaken());
  EXPECT_THAT(folder_.Entries(), IsEmpty());
}

TEST_F(WorkPlaceTest, WhoWasKilledBeforeTheLockHadItsNameIsNoObstacle) {
  fs::create_directories(folder_ / ".work/a");
  WriteFileAtomically(Lock() + ".1234-half", "{\"pro");
  EXPECT_TRUE(CanBeTaken());
  EXPECT_THAT(folder_.Entries(), IsEmpty());
}

TEST_F(WorkPlaceTest, AnotherMachinesHolderLivesAsLongAsItTouchesItsLock) {
  WriteLock("machine", "elsewhere");
  EXPECT_FALSE(CanBeTaken());
  Age(Lock(), WorkPlace::kStaleSeconds - 30);
  EXPECT_FALSE(CanBeTaken());
  Age(Lock(), WorkPlace::kStaleSeconds + 30);
  EXPECT_TRUE(CanBeTaken());
  EXPECT_THAT(folder_.Entries(), IsEmpty());
}

TEST_F(WorkPlaceTest, ThisMachinesHolderLivesHoweverLongItStandsStill) {
  const WorkPlace place(Root(), "a");
  Age(Lock(), WorkPlace::kStaleSeconds + 1000);
  EXPECT_FALSE(CanBeTaken());
}

TEST_F(WorkPlaceTest, ALockThatIsGarbageCountsUntilItIsOld) {
  for (const char* garbage : {"", "garbage", "[1,2]", "{\"process\":\"x\"}", "{\"process\":-1,\"machine\":7}"}) {
    fs::create_directories(folder_ / ".work/a");
    WriteFileAtomically(Lock(), garbage);
    EXPECT_FALSE(CanBeTaken()) << garbage;
    Age(Lock(), WorkPlace::kStaleSeconds + 30);
    EXPECT_TRUE(CanBeTaken()) << garbage;
  }
}

TEST_F(WorkPlaceTest, WhatHasLostItsLockIsNotMovedIntoPlace) {
  WorkPlace place(Root(), "a");
  WriteFileAtomically(place.folder() + "/track.npz", "late");
  WriteFileAtomically(Lock(), "{\"token\":\"thief\"}\n");
  EXPECT_THROW(place.MoveFolderTo(folder_ / "clips/a"), PlaceTaken);
  EXPECT_THROW(place.MoveFileTo("track.npz", folder_ / "clips/a.npz"), PlaceTaken);
  EXPECT_FALSE(fs::exists(folder_ / "clips"));
}

TEST_F(WorkPlaceTest, ThoseWhoLostItLeaveTheOthersLock) {
  {
    const WorkPlace place(Root(), "a");
    WriteFileAtomically(Lock(), "{\"token\":\"thief\"}\n");
  }
  EXPECT_EQ(FileBytes(Lock()), "{\"token\":\"thief\"}\n");
}

TEST_F(WorkPlaceTest, OfManyThatRushForAStaleLockOneAtATimeHasIt) {
  constexpr int kThreads = 8, kRounds = 60;
  std::atomic<int> inside{0}, together{0}, had{0};
  for (int round = 0; round < kRounds; ++round) {
    WriteLock("start", "1");
    std::vector<std::jthread> threads;
    threads.reserve(kThreads);
    for (int i = 0; i < kThreads; ++i) {
      threads.emplace_back([&] {
        try {
          const WorkPlace place(Root(), "a");
          if (++inside > 1) ++together;
          ++had;
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
          --inside;
        } catch (const PlaceTaken&) {
        }
      });
    }
  }
  EXPECT_EQ(together, 0);
  EXPECT_GE(had, kRounds / 2);
  EXPECT_THAT(folder_.Entries(), IsEmpty());
}

}  // namespace
}  // namespace bodyloom
