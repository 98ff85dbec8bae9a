// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/run_batch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <set>

#include "bodyloom/pipelines/batch/work_place.h"
#include "tests/pipelines/batch/batch_fixture.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

constexpr int kClips = 4;

/// Four tiny clips, tracked once without any disturbance.
class RunBatchTest : public ::testing::Test {
 protected:
  struct World {
    ScratchFolder folder;
    std::vector<BatchClip> clips;
    std::map<std::string, std::string> undisturbed;
  };
  static void SetUpTestSuite() {
    world_ = std::make_unique<World>();
    for (int i = 0; i < kClips; ++i) {
      world_->clips.push_back(BatchClipOf("clip" + std::to_string(i), TinyClip(world_->folder, i + 1)));
    }
    RunBatchRequest request;
    request.clips = world_->clips;
    request.out = world_->folder / "undisturbed";
    RunBatch(request);
    world_->undisturbed = ResultBytes(request.out);
  }
  static void TearDownTestSuite() { world_.reset(); }

  RunBatchTest() {
    request_.clips = world_->clips;
    request_.out = folder_ / "out";
  }
  /// Runs, and keeps what was told of each clip.
  RunBatchReport Run(const std::function<bool(const BatchProgress&)>& progress = {}) {
    told_.clear();
    BatchCallbacks callbacks;
    callbacks.progress = progress;
    callbacks.ended = [&](const ClipRecord& record) { told_.push_back(record); };
    return RunBatch(request_, callbacks);
  }
  [[nodiscard]] std::map<std::string, ClipStatus> Statuses() const {
    std::map<std::string, ClipStatus> statuses;
    for (const ClipRecord& record : told_) statuses[record.id] = record.status;
    EXPECT_EQ(statuses.size(), told_.size()) << "a clip told of twice";
    return statuses;
  }
  [[nodiscard]] const ClipRecord& Told(const std::string& id) const {
    return *std::find_if(told_.begin(), told_.end(), [&](const ClipRecord& record) { return record.id == id; });
  }
  [[nodiscard]] std::string Track(int clip) const {
    return ClipFolder(request_.out, "clip" + std::to_string(clip)) + "/track.npz";
  }
  void ExpectWhole() const {
    EXPECT_EQ(ResultBytes(request_.out), world_->undisturbed);
    EXPECT_FALSE(fs::exists(BatchWorkFolder(request_.out)));
  }

  static std::unique_ptr<World> world_;
  ScratchFolder folder_;
  RunBatchRequest request_;
  std::vector<ClipRecord> told_;
};

std::unique_ptr<RunBatchTest::World> RunBatchTest::world_;

TEST_F(RunBatchTest, EveryClipIsTrackedOnceAndThenSkipped) {
  request_.manifest = "the manifest\n";
  EXPECT_EQ(Run().Count(ClipStatus::kDone), kClips);
  EXPECT_EQ(Statuses().size(), size_t{kClips});
  ExpectWhole();
  EXPECT_EQ(FileBytes(BatchManifestFile(request_.out)), "the manifest\n");
  const auto written = fs::last_write_time(Track(2));
  EXPECT_EQ(Run().Count(ClipStatus::kSkipped), kClips);
  EXPECT_EQ(fs::last_write_time(Track(2)), written);
  EXPECT_EQ(Told("clip2").frames, 6) << "what the record holds is told again";
  EXPECT_GT(Told("clip2").reprojection_p95_px, 0);
  ExpectWhole();
}

TEST_F(RunBatchTest, WhatChangedIsDoneAgainAndNothingElse) {
  Run();
  request_.clips[1].settings["min-confidence"] = "0.1";
  std::get<TrackRequest>(request_.clips[1].request).min_confidence = 0.1;
  Run();
  EXPECT_EQ(Statuses(), (std::map<std::string, ClipStatus>{{"clip0", ClipStatus::kSkipped},
                                                           {"clip1", ClipStatus::kDone},
                                                           {"clip2", ClipStatus::kSkipped},
                                                           {"clip3", ClipStatus::kSkipped}}));
}

TEST_F(RunBatchTest, GarbageAmongTheResultsIsReplaced) {
  Run();
  std::string damaged = FileBytes(Track(0));
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  WriteFileAtomically(Track(0), damaged);
  fs::remove(Track(1));
  WriteFileAtomically(ClipFolder(request_.out, "clip2") + "/" + kClipRecordFile, "{\"id\": \"clip2\"");
  fs::remove_all(ClipFolder(request_.out, "clip3"));
  WriteFileAtomically(ClipFolder(request_.out, "clip3"), "a file where a folder is expected");
  EXPECT_EQ(Run().Count(ClipStatus::kDone), kClips);
  ExpectWhole();
}

TEST_F(RunBatchTest, AnotherClipsFolderIsNotTakenForThisOnes) {
  Run();
  fs::remove_all(ClipFolder(request_.out, "clip1"));
  fs::copy(ClipFolder(request_.out, "clip0"), ClipFolder(request_.out, "clip1"), fs::copy_options::recursive);
  EXPECT_EQ(Run().Count(ClipStatus::kDone), 1);
  ExpectWhole();
}

TEST_F(RunBatchTest, JobsAndShardsGiveTheSameBytes) {
  request_.jobs = 3;
  EXPECT_EQ(Run().Count(ClipStatus::kDone), kClips);
  ExpectWhole();
  fs::remove_all(request_.out);
  request_.jobs = 1;
  for (size_t shard = 0; shard < 2; ++shard) {
    request_.clips = {world_->clips[shard], world_->clips[shard + 2]};
    EXPECT_EQ(Run().Count(ClipStatus::kDone), 2);
  }
  ExpectWhole();
}

TEST_F(RunBatchTest, OneThatFailsStopsNoOther) {
  const ScratchFolder inputs;
  std::get<TrackRequest>(request_.clips[1].request).detections = inputs / "absent.npz";
  request_.clips[1].settings["detections"] = inputs / "absent.npz";
  request_.clips[2] = EmptyClip("clip2", inputs);
  for (int run = 0; run < 2; ++run) {
    const RunBatchReport report = Run();
    EXPECT_EQ(Statuses(),
              (std::map<std::string, ClipStatus>{{"clip0", run == 0 ? ClipStatus::kDone : ClipStatus::kSkipped},
                                                 {"clip1", ClipStatus::kFailed},
                                                 {"clip2", ClipStatus::kNothingToTrack},
                                                 {"clip3", run == 0 ? ClipStatus::kDone : ClipStatus::kSkipped}}));
    EXPECT_THAT(Told("clip1").reason, HasSubstr("absent.npz: "));
    EXPECT_THAT(Told("clip2").reason, HasSubstr("no person in any of 1 frames"));
    EXPECT_THAT(ToText(report), HasSubstr("1 with nothing to track, 1 failed"));
  }
  EXPECT_TRUE(fs::exists(FailureFile(request_.out, "clip1")));
  EXPECT_FALSE(fs::exists(ClipFolder(request_.out, "clip1")));
  request_.clips = world_->clips;
  Run();
  EXPECT_FALSE(fs::exists(FailureFile(request_.out, "clip1"))) << "put right";
  ExpectWhole();
}

TEST_F(RunBatchTest, AnInterruptionLeavesWhatIsDoneAndTheRestForAnotherTry) {
  // In the middle of the second clip.
  const RunBatchReport report = Run([](const BatchProgress& at) { return at.clip != "clip1" || at.fraction < 0.3; });
  EXPECT_EQ(report.Count(ClipStatus::kDone), 1);
  EXPECT_EQ(report.Count(ClipStatus::kRetry), kClips - 1);
  EXPECT_EQ(Told("clip1").reason, "interrupted");
  EXPECT_EQ(Told("clip3").reason, "not begun: interrupted");
  EXPECT_TRUE(fs::exists(Track(0)));
  EXPECT_FALSE(fs::exists(ClipFolder(request_.out, "clip1")));
  EXPECT_FALSE(fs::exists(BatchWorkFolder(request_.out)));
  EXPECT_EQ(Run().Count(ClipStatus::kDone), kClips - 1);
  EXPECT_EQ(Told("clip0").status, ClipStatus::kSkipped);
  ExpectWhole();
}

TEST_F(RunBatchTest, AClipThatAnotherHasComesLastAndIsLeftToIt) {
  {
    const WorkPlace other(BatchWorkFolder(request_.out), "clip0");
    Run();
    EXPECT_EQ(told_.back().id, "clip0");
    EXPECT_EQ(told_.back().status, ClipStatus::kRetry);
    EXPECT_THAT(told_.back().reason, HasSubstr("is at it"));
  }
  EXPECT_EQ(Run().Count(ClipStatus::kDone), 1);
  ExpectWhole();
}

TEST_F(RunBatchTest, WhatOneKilledAfterItsLastStepLeftIsClearedThoughItsClipIsDone) {
  Run();
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const WorkPlace place(BatchWorkFolder(request_.out), "clip0");
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(fs::exists(BatchWorkFolder(request_.out)));
  EXPECT_EQ(Run().Count(ClipStatus::kSkipped), kClips);
  ExpectWhole();
}

TEST_F(RunBatchTest, ProgressEndsAtTheWholeAndNeverFalls) {
  double last = 0;
  std::set<std::string> begun;
  Run([&](const BatchProgress& at) {
    EXPECT_GE(at.whole, last);
    EXPECT_EQ(at.all, kClips);
    last = at.whole;
    if (at.stage == kBatchStageBegin) begun.insert(at.clip);
    return true;
  });
  EXPECT_GT(last, 0.9);
  EXPECT_EQ(begun.size(), size_t{kClips});
}

TEST_F(RunBatchTest, RefusesWhatItCannotDo) {
  request_.jobs = 0;
  EXPECT_THROW(Run(), std::invalid_argument);
  request_.jobs = 1;
  WriteFileAtomically(folder_ / "file", "");
  request_.out = folder_ / "file";
  EXPECT_THROW(Run(), std::runtime_error);
}

}  // namespace
}  // namespace bodyloom
