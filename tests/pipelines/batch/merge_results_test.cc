// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/merge_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bodyloom/pipelines/batch/run_batch.h"
#include "bodyloom/pipelines/batch/work_place.h"
#include "tests/pipelines/batch/batch_fixture.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> Ids(const std::vector<MergedClip>& clips) {
  std::vector<std::string> ids;
  ids.reserve(clips.size());
  for (const MergedClip& clip : clips) ids.push_back(clip.id);
  return ids;
}

MergedClip Clip(const std::string& id, ClipStatus status, double error) {
  MergedClip clip;
  clip.id = clip.record.id = id;
  clip.record.status = status;
  clip.record.reprojection_p95_px = error;
  return clip;
}

TEST(MergeResults, WorstComeFirst) {
  MergedClip missing;
  missing.id = "missing";
  missing.is_missing = true;
  std::vector<MergedClip> clips = {Clip("good", ClipStatus::kDone, 1),
                                   Clip("bad", ClipStatus::kDone, 9),
                                   missing,
                                   Clip("nan", ClipStatus::kDone, NAN),
                                   Clip("empty", ClipStatus::kNothingToTrack, NAN),
                                   Clip("failed", ClipStatus::kFailed, NAN),
                                   Clip("also", ClipStatus::kDone, 9)};
  SortWorstFirst(&clips);
  EXPECT_THAT(Ids(clips), ElementsAre("failed", "missing", "empty", "also", "bad", "good", "nan"));
}

TEST(MergeResults, WhatAReasonHoldsStaysInItsCell) {
  MergedClip clip = Clip("a", ClipStatus::kFailed, NAN);
  clip.record.reason = "\"x\", <script>alert('1')</script>.json: no such file";
  EXPECT_EQ(ToCsv({clip}),
            "id,status,reprojection_p95_px,reprojection_median_px,frames,people,weak,interpolated,lost,seconds,reason\n"
            "a,failed,,,,,,,,,\"\"\"x\"\", <script>alert('1')</script>.json: no such file\"\n");
  MergeResultsReport report;
  report.clips = {clip};
  const std::string html = ToHtml(report);
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("http"))) << "nothing is fetched";
}

/// Two tracked, one empty, one failed, one missing.
class MergeTest : public ::testing::Test {
 protected:
  MergeTest() {
    RunBatchRequest request;
    request.out = folder_ / "out";
    request.clips = {BatchClipOf("one", TinyClip(folder_, 1)), BatchClipOf("two", TinyClip(folder_, 2)),
                     EmptyClip("empty", folder_), EmptyClip("failed", folder_)};
    std::get<TrackRequest>(request.clips[3].request).detections = folder_ / "absent.json";
    request.clips[3].settings["detections"] = folder_ / "absent.json";
    for (const char* id : {"one", "two", "empty", "failed", "missing"}) {
      request.manifest += std::string("{\"id\":\"") + id + "\",\"detections\":\"x.json\"}\n";
    }
    RunBatch(request);
  }
  [[nodiscard]] std::string Out(const std::string& name) const { return folder_ / ("out/" + name); }
  [[nodiscard]] MergeResultsReport Merge() const { return MergeResults({folder_ / "out", ""}); }
  ScratchFolder folder_;
};

TEST_F(MergeTest, TheTableIsWhatTheClipsOwnReportsSay) {
  const MergeResultsReport report = Merge();
  EXPECT_EQ(report.Count(ClipStatus::kDone), 2);
  EXPECT_EQ(report.Count(ClipStatus::kNothingToTrack), 1);
  EXPECT_EQ(report.Count(ClipStatus::kFailed), 1);
  EXPECT_EQ(report.CountMissing(), 1);
  EXPECT_THAT(report.outputs, ElementsAre(Out("clips.csv"), Out("clips.jsonl"), Out("index.html")));
  EXPECT_THAT(ToText(report), HasSubstr("missing  missing\n"));
  std::istringstream lines(FileBytes(Out("clips.jsonl")));
  int compared = 0;
  double last = std::numeric_limits<double>::infinity();
  for (std::string text; std::getline(lines, text);) {
    const nlohmann::json line = nlohmann::json::parse(text);
    if (line["status"] != "done") continue;
    const std::string id = line["id"];
    const nlohmann::json own = nlohmann::json::parse(FileBytes(Out("clips/" + id + "/report.json")));
    for (const char* key : {"frames", "frames_by_status", "reprojection_median_px", "reprojection_p95_px"}) {
      EXPECT_EQ(line[key], own[key]) << id << " " << key;
      ++compared;
    }
    EXPECT_LE(line["reprojection_p95_px"].get<double>(), last);
    last = line["reprojection_p95_px"];
    char row[64];
    std::snprintf(row, sizeof row, "\n%s,done,%.2f,%.2f,6,1,", id.c_str(), own["reprojection_p95_px"].get<double>(),
                  own["reprojection_median_px"].get<double>());
    EXPECT_THAT(FileBytes(Out("clips.csv")), HasSubstr(row));
    EXPECT_THAT(FileBytes(Out("index.html")), HasSubstr("<a href=\"clips/" + id + "/report.json\">"));
  }
  EXPECT_EQ(compared, 8);
}

TEST_F(MergeTest, GarbageAndMissingPartsAreNamed) {
  WriteFileAtomically(Out("clips/one/clip.json"), "{\"id\": 1}");
  fs::remove_all(Out("clips/two"));
  fs::create_directories(Out("clips/stranger"));
  WriteFileAtomically(Out("failures/failed.json"), "");
  const MergeResultsReport report = Merge();
  EXPECT_EQ(report.CountMissing(), 4);
  EXPECT_EQ(report.unlisted, 1);
  for (const MergedClip& clip : report.clips) {
    EXPECT_THAT(clip.record.reason, HasSubstr(clip.id == "one"   ? "one/clip.json: "
                                              : clip.id == "two" ? "no results"
                                                                 : ""));
  }
  EXPECT_THAT(FileBytes(Out("index.html")), HasSubstr("1 more among the results"));
}

TEST_F(MergeTest, AManifestOfOnesOwnSaysWhichClipsAreMeant) {
  WriteFileAtomically(folder_ / "own.jsonl", "{\"id\":\"two\",\"video\":\"v.mp4\"}\n");
  const MergeResultsReport report = MergeResults({folder_ / "out", folder_ / "own.jsonl"});
  EXPECT_THAT(Ids(report.clips), ElementsAre("two"));
  EXPECT_EQ(report.unlisted, 2);
}

TEST_F(MergeTest, OneMergeAtATimeAndNothingLeft) {
  {
    const WorkPlace other(BatchWorkFolder(folder_ / "out"), ".merge");
    EXPECT_THROW(static_cast<void>(Merge()), PlaceTaken);
  }
  EXPECT_EQ(Merge().clips.size(), 5u);
  EXPECT_FALSE(fs::exists(BatchWorkFolder(folder_ / "out")));
}

TEST(MergeResults, AFolderWithoutABatchIsRefused) {
  const ScratchFolder folder;
  EXPECT_THROW(MergeResults({folder.path(), ""}), std::runtime_error);
  EXPECT_THROW(MergeResults({folder / "absent", ""}), std::runtime_error);
}

}  // namespace
}  // namespace bodyloom
