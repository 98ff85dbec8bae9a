// SPDX-License-Identifier: Apache-2.0
#include "pipelines/batch/manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "geometry/base/callbacks.h"

namespace bodyloom::manifest_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Manifest, HoldsClipsInTheOrderOfTheLines) {
  const std::vector<ManifestClip> clips = ManifestFromText(
      "{\"id\": \"dance_01\", \"detections\": \"a/b.json\", \"fps\": 59.94, \"no-ground\": true, \"image-size\": "
      "\"1920x1080\"}\r\n"
      "\n"
      "{\"id\": \"2\", \"video\": \"/data/street.mp4\", \"people\": 2, \"prior\": \"none\"}\n"
      "{\"id\": \"x.Y-z\", \"video\": \"v.mp4\", \"verb\": \"track\", \"prior\": \"p.npz\"}",
      "lists/clips.jsonl");
  ASSERT_EQ(clips.size(), 3u);
  EXPECT_EQ(clips[0].id, "dance_01");
  EXPECT_EQ(clips[0].verb, "track");
  EXPECT_EQ(
      clips[0].settings,
      (ClipSettings{
          {"detections", "lists/a/b.json"}, {"fps", "59.94"}, {"image-size", "1920x1080"}, {"no-ground", "true"}}));
  EXPECT_EQ(clips[0].place, "lists/clips.jsonl: line 1");
  EXPECT_EQ(clips[1].verb, "run");
  EXPECT_EQ(clips[1].settings, (ClipSettings{{"people", "2"}, {"prior", "none"}, {"video", "/data/street.mp4"}}));
  EXPECT_EQ(clips[1].place, "lists/clips.jsonl: line 3");
  EXPECT_EQ(clips[2].verb, "track");
  EXPECT_EQ(clips[2].settings.at("prior"), "lists/p.npz");
}

TEST(Manifest, PathsAreTakenFromTheManifestsFolder) {
  const std::string line = "{\"id\":\"a\",\"video\":\"v.mp4\"}";
  EXPECT_EQ(ManifestFromText(line, "lists/clips.jsonl")[0].settings.at("video"), "lists/v.mp4");
  EXPECT_EQ(ManifestFromText(line, "clips.jsonl")[0].settings.at("video"), "v.mp4");
}

void ExpectRefused(const std::string& text, const std::string& place, const std::string& reason) {
  try {
    ManifestFromText(text, "c.jsonl");
    ADD_FAILURE() << "accepted: " << text;
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith("c.jsonl: " + place), HasSubstr(reason), HasSubstr("expected")));
  }
}

TEST(Manifest, RefusesLinesByNumberAndSaysWhatWasExpected) {
  const std::string good = "{\"id\":\"good\",\"video\":\"v.mp4\"}\n";
  ExpectRefused("", "no clips", "one JSON object a line");
  ExpectRefused("\n \r\n", "no clips", "one JSON object a line");
  ExpectRefused(good + "[1]", "line 2", "array");
  ExpectRefused(good + good, "line 2", "'good' is that of line 1");
  ExpectRefused(good + "{\"id\":\"GOOD\",\"video\":\"v.mp4\"}", "line 2", "is that of line 1");
  ExpectRefused(good + "{\"video\":\"v.mp4\"}", "line 2", "no 'id'");
  ExpectRefused(good + "{\"id\":7,\"video\":\"v.mp4\"}", "line 2: id", "a text");
  ExpectRefused(good + "{\"id\":\"a\"}", "line 2", "no input");
  ExpectRefused(good + "{\"id\":\"a\",\"fps\":30}", "line 2", "no input");
  ExpectRefused(good + "{\"id\":\"a\",\"video\":\"v.mp4\",\"verb\":\"render\"}", "line 2", "verb 'render'");
  ExpectRefused(good + "{\"id\":\"a\",\"video\":\"\"}", "line 2: video", "not empty");
  ExpectRefused(good + "{\"id\":\"a\",\"video\":\"v\\nw\"}", "line 2: video", "one line");
  ExpectRefused(good + "{\"id\":\"a\",\"video\":null}", "line 2: video", "null");
  ExpectRefused(good + "{\"id\":\"a\",\"video\":[\"v.mp4\"]}", "line 2: video", "array");
  ExpectRefused(good + "{\"id\":\"a\",\"video\":\"v.mp4\",\"a\\nb\":null}", "line 2: a?b", "null");
  for (const char* key : {"out", "json", "quiet", "plan", "no-overlay", "help"}) {
    try {
      ManifestFromText(good + "{\"id\":\"a\",\"video\":\"v.mp4\",\"" + key + "\":\"x\"}", "c.jsonl");
      ADD_FAILURE() << key;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::string("'") + key + "' is no option of a clip"));
    }
  }
  for (const char* garbage : {"{", "nonsense", "{\"id\":\"a\",}", "\xff\xfe", "{\"id\":\"a\",\"fps\":NaN}"}) {
    try {
      ManifestFromText(good + garbage, "c.jsonl");
      ADD_FAILURE() << garbage;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), StartsWith("c.jsonl: line 2: byte "));
    }
  }
}

TEST(Manifest, IdsAreSafeNamesOfFolders) {
  const auto line = [](const std::string& id) { return "{\"id\":\"" + id + "\",\"video\":\"v.mp4\"}"; };
  const std::vector<std::string> safe = {"a", "7", "A_b-c.d", std::string(100, 'x')};
  for (const std::string& id : safe) EXPECT_EQ(ManifestFromText(line(id), "c.jsonl")[0].id, id);
  const std::vector<std::string> others = {
      "..", ".", ".hidden", "-x", "_x", "a/b", "../a", "a b", "a\\\\b", "a:b", "\xc3\xa4", "a*", std::string(101, 'x')};
  for (const std::string& id : others) ExpectRefused(line(id), "line 1", "first a letter or digit");
}

std::vector<ManifestClip> Clips(int count) {
  std::vector<ManifestClip> clips(static_cast<size_t>(count));
  for (int k = 0; k < count; ++k) clips[static_cast<size_t>(k)].id = std::to_string(k);
  return clips;
}

TEST(Shard, EveryClipBelongsToOneShardAndNoneIsLargerThanAnotherByTwo) {
  for (int shards = 1; shards <= 17; ++shards) {
    for (const int count : {0, 1, 5, 16, 17, 100}) {
      std::set<std::string> owned;
      size_t minimum = 100, maximum = 0, all = 0;
      for (int i = 0; i < shards; ++i) {
        const std::vector<ManifestClip> own = ShardOf(Clips(count), std::to_string(i) + "/" + std::to_string(shards));
        for (const ManifestClip& clip : own) owned.insert(clip.id);
        all += own.size();
        minimum = std::min(minimum, own.size());
        maximum = std::max(maximum, own.size());
      }
      EXPECT_EQ(owned.size(), static_cast<size_t>(count)) << count << " clips in " << shards << " shards";
      EXPECT_EQ(all, owned.size());
      EXPECT_LE(maximum - minimum, 1u);
    }
  }
  EXPECT_EQ(ShardOf(Clips(8), "1/3").at(2).id, "7");
}

TEST(Shard, OtherTextsAreRefused) {
  for (const char* text : {"", "/", "6", "6/6", "7/6", "-1/6", "1/0", "0/0", "1 /6", "1/6 ", "+1/6", "a/b", "1/6/2",
                           "1/", "/6", "0x1/6", "1.0/6", "1/-6", "0/99999999999999999999"}) {
    EXPECT_THROW(ShardOf(Clips(3), text), RequestError) << text;
  }
}

}  // namespace
}  // namespace bodyloom::manifest_test
