// SPDX-License-Identifier: Apache-2.0
#include "pipelines/batch/batch_clip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "pipelines/track/track_clip.h"
#include "tests/pipelines/batch/batch_fixture.h"

namespace bodyloom::batch_clip_test {
namespace {

namespace fs = std::filesystem;

/// Two files and a folder, as inputs whose contents no reader needs to understand.
class ClipHashTest : public ::testing::Test {
 protected:
  ClipHashTest() {
    fs::create_directories(folder_ / "openpose");
    WriteFileAtomically(folder_ / "openpose/0.json", "first");
    WriteFileAtomically(folder_ / "openpose/1.json", "second");
    WriteFileAtomically(folder_ / "camera.json", "camera");
    clip_.id = "a";
    clip_.settings = {{"detections", folder_ / "openpose"}, {"cameras", folder_ / "camera.json"}, {"fps", "30"}};
    TrackRequest request;
    request.detections = folder_ / "openpose";
    clip_.request = request;
  }
  [[nodiscard]] std::string Hash() const { return ClipHash(clip_, "1.0"); }
  ScratchFolder folder_;
  BatchClip clip_;
};

TEST_F(ClipHashTest, EveryByteOfEveryInputCounts) {
  const std::string hash = Hash();
  EXPECT_EQ(hash.size(), 64u);
  for (const char* name : {"openpose/0.json", "openpose/1.json", "camera.json"}) {
    const std::string bytes = FileBytes(folder_ / name);
    for (size_t i = 0; i < bytes.size(); ++i) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ 1);
      WriteFileAtomically(folder_ / name, changed);
      EXPECT_NE(Hash(), hash) << name << " byte " << i;
    }
    WriteFileAtomically(folder_ / name, bytes + "x");
    EXPECT_NE(Hash(), hash) << name << " longer";
    WriteFileAtomically(folder_ / name, bytes);
    EXPECT_EQ(Hash(), hash) << name << " written again";
  }
  WriteFileAtomically(folder_ / "openpose/2.json", "");
  EXPECT_NE(Hash(), hash) << "a file more";
}

TEST_F(ClipHashTest, EverySettingAndTheVersionAndTheVerbCount) {
  const std::string hash = Hash();
  EXPECT_NE(ClipHash(clip_, "1.1"), hash);
  for (const auto& [name, value] : clip_.settings) {
    BatchClip other = clip_;
    other.settings.erase(name);
    EXPECT_NE(ClipHash(other, "1.0"), hash) << name << " left out";
  }
  BatchClip other = clip_;
  other.settings["fps"] = "31";
  EXPECT_NE(ClipHash(other, "1.0"), hash);
  other = clip_;
  other.settings["no-ground"] = "true";
  EXPECT_NE(ClipHash(other, "1.0"), hash);
  other = clip_;
  TrackPeopleClipRequest people;
  people.track = std::get<TrackRequest>(clip_.request);
  other.request = people;
  EXPECT_NE(ClipHash(other, "1.0"), hash);
}

TEST_F(ClipHashTest, NeitherThreadsNorIdNorPlaceCounts) {
  const std::string hash = Hash();
  clip_.settings["threads"] = "2";
  clip_.id = "b";
  EXPECT_EQ(Hash(), hash);
  fs::create_directories(folder_ / "elsewhere");
  fs::rename(folder_ / "openpose", folder_ / "elsewhere/openpose");
  EXPECT_THROW(Hash(), std::runtime_error);
  clip_.settings["detections"] = folder_ / "elsewhere/openpose/";
  EXPECT_NE(Hash(), "");
  clip_.settings["detections"] = folder_ / "elsewhere/openpose";
  EXPECT_EQ(Hash(), hash);
  fs::rename(folder_ / "elsewhere/openpose", folder_ / "elsewhere/other");
  clip_.settings["detections"] = folder_ / "elsewhere/other";
  EXPECT_NE(Hash(), hash) << "its own name does count: some formats are told apart by it";
}

ClipRecord SampleRecord(const std::string& id = "a", ClipStatus status = ClipStatus::kDone, double error = 4.25) {
  ClipRecord record;
  record.id = id;
  record.verb = "track";
  record.status = status;
  record.hash = std::string(64, 'f');
  record.seconds = 1.25;
  record.frames = 6;
  record.people = 1;
  record.frames_by_status = {{"lost", 1}, {"tracked", 5}};
  record.reprojection_median_px = 1.5;
  record.reprojection_p95_px = error;
  return record;
}

TEST(ClipRecord, IsReadAsItWasWritten) {
  EXPECT_EQ(ToLine(ClipRecordFromText(ToLine(SampleRecord()), "clip.json")), ToLine(SampleRecord()));
  ClipRecord nothing;
  nothing.id = "b";
  nothing.status = ClipStatus::kNoPersonFound;
  nothing.reason = "b.json: nobody \"there\"";
  const ClipRecord read = ClipRecordFromText(ToLine(nothing), "clip.json");
  EXPECT_EQ(read.status, ClipStatus::kNoPersonFound);
  EXPECT_EQ(read.reason, nothing.reason);
  EXPECT_TRUE(std::isnan(read.reprojection_median_px));
}

TEST(ClipRecord, ALineIsOneObjectInOneLine) {
  ClipRecord record = SampleRecord();
  record.reason = "two\nlines";
  const std::string line = ToLine(record);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const nlohmann::json json = nlohmann::json::parse(line);
  EXPECT_EQ(json["id"], "a");
  EXPECT_EQ(json["status"], "done");
  EXPECT_EQ(json["seconds"], 1.25);
  EXPECT_EQ(json["frames_by_status"]["tracked"], 5);
}

TEST(ClipRecord, RefusesGarbageInOneLine) {
  const std::string good = ToLine(SampleRecord());
  const auto with = [&](const std::string& key, const nlohmann::json& value) {
    nlohmann::json json = nlohmann::json::parse(good);
    json[key] = value;
    return json.dump();
  };
  for (const std::string& text :
       {std::string(), std::string("[]"), good.substr(0, good.size() / 2), with("status", "perhaps"),
        with("frames", 1.5), with("id", 7), with("seconds", "long"), with("hash", nullptr)}) {
    try {
      ClipRecordFromText(text, "clip.json");
      ADD_FAILURE() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("clip.json: ")) << error.what();
    }
  }
}

TEST(ClipTable, WorstComeFirstAndAReasonStaysInItsCell) {
  ClipRecord failed = SampleRecord("failed", ClipStatus::kFailed, NAN);
  failed.reason = "\"x\", y.json: no such file";
  ClipRecord good = SampleRecord("good", ClipStatus::kDone, 1);
  good.frames_by_status = {{"weak", 2}, {"interpolated", 3}, {"lost", 4}};
  const std::string table = ToCsv(
      {good, SampleRecord("bad", ClipStatus::kDone, 9), SampleRecord("nan", ClipStatus::kDone, NAN),
       SampleRecord("empty", ClipStatus::kNoPersonFound, NAN), failed, SampleRecord("also", ClipStatus::kDone, 9)});
  EXPECT_EQ(table,
            "id,status,reprojection_p95_px,reprojection_median_px,frames,people,weak,interpolated,lost,seconds,reason\n"
            "failed,failed,,1.50,6,1,0,0,1,1.25,\"\"\"x\"\", y.json: no such file\"\n"
            "empty,nothing_to_track,,1.50,6,1,0,0,1,1.25,\"\"\n"
            "also,done,9.00,1.50,6,1,0,0,1,1.25,\"\"\n"
            "bad,done,9.00,1.50,6,1,0,0,1,1.25,\"\"\n"
            "good,done,1.00,1.50,6,1,2,3,4,1.25,\"\"\n"
            "nan,done,,1.50,6,1,0,0,1,1.25,\"\"\n");
}

TEST(TrackBatchClip, LeavesNoFileOfAClipThatShowsNobody) {
  const ScratchFolder folder;
  fs::create_directories(folder / "batch");
  const ClipRecord record = TrackBatchClip(EmptyClip("e", folder), folder / "batch");
  EXPECT_EQ(record.status, ClipStatus::kNoPersonFound);
  EXPECT_NE(record.reason.find("no person in any of 1 frames"), std::string::npos) << record.reason;
  EXPECT_TRUE(fs::is_empty(folder / "batch"));
}

TEST(TrackBatchClip, WritesWhatTrackWrites) {
  const ScratchFolder folder;
  const BatchClip clip = BatchClipOf("a", TinyClip(folder, 1));
  fs::create_directories(folder / "batch");
  const ClipRecord record = TrackBatchClip(clip, folder / "batch");
  TrackRequest alone = std::get<TrackRequest>(clip.request);
  alone.out = folder / "alone.npz";
  const TrackReport report = TrackClip(alone);
  EXPECT_EQ(FileBytes(folder / "batch/track.npz"), FileBytes(alone.out));
  EXPECT_EQ(record.status, ClipStatus::kDone);
  EXPECT_EQ(record.frames, 6);
  EXPECT_EQ(record.people, 1);
  EXPECT_EQ(record.frames_by_status, report.solve.frames_by_status);
  EXPECT_EQ(record.reprojection_median_px, report.solve.reprojection_median_px);
  EXPECT_EQ(record.reprojection_p95_px, report.solve.reprojection_p95_px);
  const nlohmann::json written = nlohmann::json::parse(FileBytes(folder / "batch/report.json"));
  EXPECT_EQ(written["outputs"], nlohmann::json({"track.npz"})) << "without the folder, which is moved";
  EXPECT_EQ(written["reprojection_median_px"], report.solve.reprojection_median_px);
}

}  // namespace
}  // namespace bodyloom::batch_clip_test
