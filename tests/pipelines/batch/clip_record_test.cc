// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/clip_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

ClipRecord Sample() {
  ClipRecord record;
  record.id = "a";
  record.verb = "track";
  record.status = ClipStatus::kDone;
  record.hash = std::string(64, 'f');
  record.version = "1.0";
  record.seconds = 1.25;
  record.frames = 6;
  record.people = 1;
  record.frames_by_status = {{"lost", 1}, {"tracked", 5}};
  record.reprojection_median_px = 1.5;
  record.reprojection_p95_px = 4.25;
  return record;
}

TEST(ClipRecord, IsReadAsItWasWritten) {
  ClipRecord record = Sample();
  record.files["track.npz"] = {7, std::string(64, '0')};
  const ClipRecord read = ClipRecordFromText(ToJson(record), "clip.json");
  EXPECT_EQ(ToJson(read), ToJson(record));
  EXPECT_EQ(read.files.at("track.npz").bytes, 7u);
  ClipRecord nothing;
  nothing.id = "b";
  nothing.status = ClipStatus::kNothingToTrack;
  nothing.reason = "b.json: nobody \"there\"";
  const ClipRecord read_nothing = ClipRecordFromText(ToJson(nothing), "clip.json");
  EXPECT_EQ(read_nothing.status, ClipStatus::kNothingToTrack);
  EXPECT_EQ(read_nothing.reason, nothing.reason);
  EXPECT_TRUE(std::isnan(read_nothing.reprojection_median_px));
}

TEST(ClipRecord, ALineIsOneObjectInOneLine) {
  ClipRecord record = Sample();
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
  const std::string good = ToJson(Sample());
  const auto with = [&](const std::string& key, const nlohmann::json& value) {
    nlohmann::json json = nlohmann::json::parse(good);
    json[key] = value;
    return json.dump();
  };
  for (const std::string& text :
       {std::string(), std::string("[]"), good.substr(0, good.size() / 2), with("status", "perhaps"),
        with("frames", -1), with("frames", 1.5), with("id", "a\nb"), with("seconds", "long"),
        with("files", {{"../x", 1}}), with("files", {{"x", {{"bytes", -1}, {"sha256", ""}}}}), with("hash", nullptr)}) {
    try {
      ClipRecordFromText(text, "clip.json");
      ADD_FAILURE() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), StartsWith("clip.json: "));
    }
  }
}

TEST(ClipRecord, AFolderIsWholeWithTheSameFilesOnly) {
  const ScratchFolder folder;
  ClipRecord record = Sample();
  const std::string path = folder / kClipRecordFile;
  EXPECT_FALSE(ReadWholeClip(folder.path(), "a")) << "no record";
  WriteFileAtomically(folder / "track.npz", "bytes");
  record.files = ResultFilesOf(folder.path());
  ASSERT_EQ(record.files.size(), 1u);
  WriteFileAtomically(path, ToJson(record));
  ASSERT_EQ(ResultFilesOf(folder.path()).size(), 1u) << "the record is none of its files";
  EXPECT_TRUE(ReadWholeClip(folder.path(), "a"));
  EXPECT_FALSE(ReadWholeClip(folder.path(), "b")) << "another clip's";
  for (const char* other : {"bytez", "byte", "", "bytes "}) {
    WriteFileAtomically(folder / "track.npz", other);
    EXPECT_FALSE(ReadWholeClip(folder.path(), "a")) << other;
  }
  std::filesystem::remove(folder / "track.npz");
  EXPECT_FALSE(ReadWholeClip(folder.path(), "a")) << "gone";
  WriteFileAtomically(folder / "track.npz", "bytes");
  WriteFileAtomically(path, "garbage");
  EXPECT_FALSE(ReadWholeClip(folder.path(), "a"));
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  EXPECT_FALSE(ReadWholeClip(folder.path(), "a"));
}

}  // namespace
}  // namespace bodyloom
