// SPDX-License-Identifier: Apache-2.0
#include "pipelines/batch/run_batch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <thread>

#include "tests/pipelines/batch/batch_fixture.h"

namespace bodyloom::run_batch_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kClips = 4;
using Counts = std::map<ClipStatus, int>;

/// Four tiny clips, tracked once without any disturbance.
class RunBatchTest : public ::testing::Test {
 protected:
  struct World {
    ScratchFolder folder;
    std::vector<BatchClip> clips;
    std::vector<std::string> ids;
    std::map<std::string, std::string> undisturbed;
  };
  static void SetUpTestSuite() {
    world_ = std::make_unique<World>();
    for (int i = 0; i < kClips; ++i) {
      world_->ids.push_back("clip" + std::to_string(i));
      world_->clips.push_back(BatchClipOf(world_->ids.back(), TinyClip(world_->folder, i + 1)));
    }
    RunBatchRequest request;
    request.clips = world_->clips;
    request.ids_of_table = world_->ids;
    request.out = world_->folder / "undisturbed";
    RunBatch(request);
    world_->undisturbed = ResultBytes(request.out);
    ASSERT_EQ(world_->undisturbed.size(), size_t{kClips});
  }
  static void TearDownTestSuite() { world_.reset(); }

  RunBatchTest() {
    request_.clips = world_->clips;
    request_.ids_of_table = world_->ids;
    request_.out = folder_ / "out";
  }
  /// Runs, and keeps what was told of each clip.
  Counts Run(const std::function<bool(const std::string&, double)>& progress = {}) {
    told_.clear();
    request_.on_ended = [this](const ClipRecord& record) {
      EXPECT_TRUE(told_.emplace(record.id, record).second) << "a clip told of twice";
    };
    PipelineCallbacks callbacks;
    callbacks.progress = progress;
    report_ = RunBatch(request_, callbacks);
    return report_.clips;
  }
  [[nodiscard]] std::string Clip(int clip) const { return request_.out + "/clips/clip" + std::to_string(clip); }
  [[nodiscard]] std::string Failure(int clip) const {
    return request_.out + "/failed/clip" + std::to_string(clip) + ".json";
  }
  [[nodiscard]] std::string Table() const { return FileBytes(request_.out + "/clips.csv"); }
  void ExpectWhole() const {
    EXPECT_EQ(ResultBytes(request_.out), world_->undisturbed);
    EXPECT_TRUE(fs::is_empty(request_.out + "/.work"));
  }

  static std::unique_ptr<World> world_;
  ScratchFolder folder_;
  RunBatchRequest request_;
  RunBatchReport report_;
  std::map<std::string, ClipRecord> told_;
};

std::unique_ptr<RunBatchTest::World> RunBatchTest::world_;

TEST_F(RunBatchTest, EveryClipIsTrackedOnceAndThenSkipped) {
  EXPECT_EQ(Run(), (Counts{{ClipStatus::kDone, kClips}}));
  EXPECT_EQ(told_.size(), size_t{kClips});
  ExpectWhole();
  const auto written = fs::last_write_time(Clip(2) + "/track.npz");
  EXPECT_EQ(Run(), (Counts{{ClipStatus::kSkipped, kClips}}));
  EXPECT_EQ(fs::last_write_time(Clip(2) + "/track.npz"), written);
  EXPECT_EQ(told_.at("clip2").frames, 6) << "what the record holds is told again";
  EXPECT_GT(told_.at("clip2").reprojection_p95_px, 0);
  ExpectWhole();
}

TEST_F(RunBatchTest, ResultsCanBeReadByWhomeverTheUmaskLets) {
  Run();
  EXPECT_EQ(fs::status(Clip(0)).permissions(), fs::status(request_.out).permissions());
}

TEST_F(RunBatchTest, WhatChangedIsDoneAgainAndNothingElse) {
  Run();
  WriteFileAtomically(Clip(1) + "/older.txt", "");
  request_.clips[1].settings["min-confidence"] = "0.1";
  std::get<TrackRequest>(request_.clips[1].request).min_confidence = 0.1;
  EXPECT_EQ(Run(), (Counts{{ClipStatus::kDone, 1}, {ClipStatus::kSkipped, kClips - 1}}));
  EXPECT_EQ(told_.at("clip1").status, ClipStatus::kDone);
  EXPECT_FALSE(fs::exists(Clip(1) + "/older.txt")) << "the folder is replaced as a whole";
  EXPECT_TRUE(fs::is_empty(request_.out + "/.work"));
}

TEST_F(RunBatchTest, GarbageAmongTheResultsIsReplaced) {
  Run();
  fs::remove(Clip(0) + "/clip.json");
  WriteFileAtomically(Clip(1) + "/clip.json", "{\"id\": \"clip1\"");
  fs::remove_all(Clip(2));
  WriteFileAtomically(Clip(2), "a file where a folder is expected");
  fs::remove_all(Clip(3));
  EXPECT_EQ(Run(), (Counts{{ClipStatus::kDone, kClips}}));
  ExpectWhole();
}

TEST_F(RunBatchTest, AnotherClipsFolderIsNotTakenForThisOnes) {
  Run();
  fs::remove_all(Clip(1));
  fs::copy(Clip(0), Clip(1), fs::copy_options::recursive);
  EXPECT_EQ(Run(), (Counts{{ClipStatus::kDone, 1}, {ClipStatus::kSkipped, kClips - 1}}));
  ExpectWhole();
}

TEST_F(RunBatchTest, JobsAndShardsGiveTheSameBytesAndTheLastShardTheTable) {
  request_.jobs = 3;
  EXPECT_EQ(Run(), (Counts{{ClipStatus::kDone, kClips}}));
  ExpectWhole();
  const auto rows = [&] {
    return Table().substr(0, Table().find("\n")) + std::to_string(std::ranges::count(Table(), '\n'));
  };
  const std::string whole = rows();
  request_.jobs = 1;
  for (const size_t first : {0, 1}) {  // whichever shard comes first
    fs::remove_all(request_.out);
    for (const size_t shard : {first, 1 - first}) {
      EXPECT_FALSE(fs::exists(request_.out + "/clips.csv")) << "a table in which clips are missing";
      request_.clips = {world_->clips[shard], world_->clips[shard + 2]};
      EXPECT_EQ(Run(), (Counts{{ClipStatus::kDone, 2}}));
      EXPECT_EQ(report_.table.empty(), shard == first);
      EXPECT_THAT(ToText(report_),
                  HasSubstr(shard == first ? "2 done, no table yet" : "2 done, table: " + report_.table));
    }
    ExpectWhole();
    EXPECT_EQ(rows(), whole);
  }
}

TEST_F(RunBatchTest, TheTableIsThereOnceShardsThatRunAtTheSameTimeHaveEnded) {
  for (int round = 0; round < 5; ++round) {
    fs::remove_all(request_.out);
    {
      std::vector<std::jthread> shards;
      for (int i = 0; i < kClips; ++i) {
        shards.emplace_back([&, i] {
          RunBatchRequest request = request_;
          request.clips = {world_->clips[static_cast<size_t>(i)]};
          EXPECT_EQ(RunBatch(request).clips, (Counts{{ClipStatus::kDone, 1}}));
        });
      }
    }
    ExpectWhole();
    for (const std::string& id : world_->ids) EXPECT_THAT(Table(), HasSubstr("\n" + id + ",done,"));
  }
}

TEST_F(RunBatchTest, OneThatFailsStopsNoOtherAndIsNamedWithItsReason) {
  const ScratchFolder inputs;
  std::get<TrackRequest>(request_.clips[1].request).detections = inputs / "absent.npz";
  request_.clips[1].settings["detections"] = inputs / "absent.npz";
  request_.clips[2] = EmptyClip("clip2", inputs);
  for (const ClipStatus others : {ClipStatus::kDone, ClipStatus::kSkipped}) {
    EXPECT_EQ(Run(), (Counts{{ClipStatus::kFailed, 1}, {ClipStatus::kNoPersonFound, 1}, {others, 2}}));
    EXPECT_THAT(told_.at("clip1").reason, HasSubstr("absent.npz: "));
    EXPECT_THAT(told_.at("clip2").reason, HasSubstr("no person in any of 1 frames"));
    EXPECT_THAT(ToText(report_), HasSubstr("1 failed, 1 nothing_to_track, 2 "));
    EXPECT_THAT(Table(), HasSubstr("\nclip1,failed,,,0,0,0,0,0,0.00,\"" + told_.at("clip1").reason + "\"\nclip2,noth"));
  }
  EXPECT_TRUE(fs::exists(Failure(1)));
  EXPECT_FALSE(fs::exists(Clip(1)));
  request_.clips = world_->clips;
  Run();
  EXPECT_FALSE(fs::exists(Failure(1))) << "put right";
  EXPECT_THAT(Table(), Not(HasSubstr("failed")));
  ExpectWhole();
}

TEST_F(RunBatchTest, ATableThatIsRightIsLeftAlone) {
  Run();
  const std::string table = request_.out + "/clips.csv", whole = Table();
  const auto written = fs::last_write_time(table);
  Run();
  EXPECT_EQ(fs::last_write_time(table), written);
  WriteFileAtomically(table, "id,status\n");
  Run();
  EXPECT_EQ(Table(), whole);
}

TEST_F(RunBatchTest, AFailureLeavesOlderResultsWhereTheyAre) {
  Run();
  request_.clips[1].settings["detections"] = folder_ / "absent.npz";
  EXPECT_EQ(Run(), (Counts{{ClipStatus::kFailed, 1}, {ClipStatus::kSkipped, kClips - 1}}));
  ExpectWhole();
  EXPECT_THAT(Table(), HasSubstr("\nclip1,failed,"));
}

TEST_F(RunBatchTest, AnInterruptionLeavesWhatIsDoneAndTheRestForAnotherRun) {
  // In the middle of the second clip.
  const double limit = 1.3 / kClips;
  EXPECT_THROW(Run([&](const std::string&, double whole) { return whole < limit; }), Cancelled);
  EXPECT_EQ(told_.size(), 1u);
  EXPECT_TRUE(fs::exists(Clip(0)));
  EXPECT_FALSE(fs::exists(Clip(1)));
  EXPECT_TRUE(fs::is_empty(request_.out + "/.work"));
  EXPECT_EQ(Run(), (Counts{{ClipStatus::kDone, kClips - 1}, {ClipStatus::kSkipped, 1}}));
  ExpectWhole();
}

TEST_F(RunBatchTest, WhatKilledRunsLeftGoesWhenTheClipIsDone) {
  const auto leave = [&](const std::string& name) {
    fs::create_directories(request_.out + "/.work/" + name + "/finished");
    WriteFileAtomically(request_.out + "/.work/" + name + "/finished/track.npz", "half");
  };
  leave("clip0~abcdef");
  leave("clip0~ghijkl~");
  leave("clip1~mnopqr");
  Run();
  ExpectWhole();
  leave("clip0~abcdef");
  leave("clip0~ghijkl~");
  leave("clip00~abcdef");
  EXPECT_EQ(Run(), (Counts{{ClipStatus::kSkipped, kClips}})) << "killed after its last step";
  EXPECT_FALSE(fs::exists(request_.out + "/.work/clip0~abcdef"));
  EXPECT_FALSE(fs::exists(request_.out + "/.work/clip0~ghijkl~"));
  EXPECT_TRUE(fs::exists(request_.out + "/.work/clip00~abcdef")) << "of another shard";
}

TEST_F(RunBatchTest, OfTwoWithTheSameClipTheResultsThatComeFirstStay) {
  // The other one does all clips while this one is in the middle of the first, and clears up.
  bool others = false;
  std::map<std::string, std::string> first;
  const Counts counts = Run([&](const std::string&, double whole) {
    if (whole > 0.5 / kClips && !others) {
      others = true;
      RunBatchRequest other = request_;
      other.on_ended = {};
      EXPECT_EQ(RunBatch(other).clips, (Counts{{ClipStatus::kDone, kClips}}));
      first["clip0"] = FileBytes(Clip(0) + "/clip.json");
    }
    return true;
  });
  EXPECT_TRUE(others);
  EXPECT_EQ(counts, (Counts{{ClipStatus::kSkipped, kClips}}));
  EXPECT_EQ(FileBytes(Clip(0) + "/clip.json"), first["clip0"]);
  EXPECT_FALSE(fs::exists(Failure(0)));
  ExpectWhole();
}

TEST_F(RunBatchTest, TwoOnTheSameClipsAtOnceLeaveThemWhole) {
  for (int round = 0; round < 5; ++round) {
    fs::remove_all(request_.out);
    request_.on_ended = {};
    {
      std::vector<std::jthread> both;
      for (int i = 0; i < 2; ++i) {
        both.emplace_back([&] {
          RunBatchReport report = RunBatch(request_);
          EXPECT_EQ(report.clips[ClipStatus::kDone] + report.clips[ClipStatus::kSkipped], kClips);
        });
      }
    }
    EXPECT_FALSE(fs::exists(request_.out + "/failed"));
    EXPECT_EQ(Run(), (Counts{{ClipStatus::kSkipped, kClips}}));
    ExpectWhole();  // of .work only now: each may have cleared up where the other was clearing up
  }
}

TEST_F(RunBatchTest, ProgressCountsClips) {
  std::vector<std::string> stages;
  double last = 0;
  Run([&](const std::string& stage, double whole) {
    if (stages.empty() || stages.back() != stage) stages.push_back(stage);
    EXPECT_GE(whole, last);
    last = whole;
    return true;
  });
  EXPECT_EQ(stages, (std::vector<std::string>{"0 of 4", "1 of 4", "2 of 4", "3 of 4"}));
  EXPECT_GT(last, 0.9);
}

TEST_F(RunBatchTest, RefusesAFolderThatCannotBeOne) {
  WriteFileAtomically(folder_ / "file", "");
  request_.out = folder_ / "file";
  EXPECT_THROW(Run(), std::runtime_error);
}

}  // namespace
}  // namespace bodyloom::run_batch_test
