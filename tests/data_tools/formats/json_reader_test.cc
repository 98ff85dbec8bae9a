// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/json_reader.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "data_tools/formats/atomic_file.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::json_reader_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const char* const kText = R"({"a": [1, 2.5, [-3e2]], "b": {"c": "x]}[{N"}, "d": null, "e": true})";

TEST(JsonReader, ReadsAFileThroughACursor) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.json");
  WriteFileAtomically(path, kText);
  const nlohmann::json json = ReadJsonFile(path);
  const JsonNode root(json, path);
  EXPECT_THAT(root.At("a").Numbers(), ElementsAre(1, 2.5, -300));
  EXPECT_THAT(root.At("a").Numbers(3), ElementsAre(1, 2.5, -300));
  EXPECT_EQ(root.At("b").At("c").Text(), "x]}[{N");
  EXPECT_EQ(root.At("a").At(0).Integer(), 1);
  EXPECT_TRUE(root.At("d").is_null());
  EXPECT_TRUE(root.Has("e"));
  EXPECT_FALSE(root.Has("f"));
  EXPECT_FALSE(root.At("a").Has("f"));
  EXPECT_EQ(root.size(), 4U);
}

TEST(JsonReader, EveryTruncationIsAnError) {
  const std::string text = kText;
  for (size_t n = 0; n < text.size(); ++n) {
    EXPECT_THAT(FileErrorOf("t.json", [&] { ParseJson(text.substr(0, n), "t.json"); }), HasSubstr("byte"));
  }
}

TEST(JsonReader, DeepNestingIsRefusedBeforeItIsBuilt) {
  std::string deep(1000, '[');
  deep += std::string(1000, ']');
  EXPECT_THAT(FileErrorOf("t.json", [&] { ParseJson(deep, "t.json"); }), HasSubstr("byte 64: nested deeper than 64"));
  std::string objects;
  for (int i = 0; i < 1000; ++i) objects += "{\"a\":";
  EXPECT_THAT(FileErrorOf("t.json", [&] { ParseJson(objects, "t.json"); }), HasSubstr("nested deeper than 64"));
  const std::string allowed = std::string(64, '[') + std::string(64, ']');
  EXPECT_NO_THROW(ParseJson(allowed, "t.json"));
  // Ten million brackets must not cost a stack.
  const std::string brackets(10'000'000, '[');  // NOLINT(bugprone-string-constructor): large is meant
  FileErrorOf("t.json", [&] { ParseJson(brackets, "t.json"); });
}

TEST(JsonReader, NumbersThatJsonDoesNotHave) {
  for (const char* text : {"[NaN]", "[1, -Infinity]", "{\"a\": Infinity}", "[\"N\", NaN]"}) {
    EXPECT_THAT(FileErrorOf("t.json", [&] { ParseJson(text, "t.json"); }), HasSubstr("NaN or Infinity"));
  }
  EXPECT_THAT(FileErrorOf("t.json", [&] { ParseJson("[1, NaN]", "t.json"); }), HasSubstr("byte 4"));
  FileErrorOf("t.json", [&] { ParseJson("[1e999]", "t.json"); });
  FileErrorOf("t.json", [&] { ParseJson("[\"\xff\"]", "t.json"); });
  FileErrorOf("t.json", [&] { ParseJson("[1] 2", "t.json"); });
}

TEST(JsonReader, SizeLimit) {
  JsonLimits limits;
  limits.max_bytes = 10;
  EXPECT_THAT(FileErrorOf("t.json", [&] { ParseJson("[1,2,3,4,5,6]", "t.json", limits); }), HasSubstr("13 bytes"));
  const TemporaryFolder folder;
  WriteFileAtomically(folder.File("big.json"), "[1,2,3,4,5,6]");
  FileErrorOf("big.json", [&] { ReadJsonFile(folder.File("big.json"), limits); });
  FileErrorOf("absent.json", [&] { ReadJsonFile(folder.File("absent.json")); });
}

TEST(JsonReader, ErrorsNameThePlace) {
  const nlohmann::json json = ParseJson(kText, "t.json");
  const JsonNode root(json, "t.json");
  const auto error = [&](const auto& action) { return FileErrorOf("t.json", action); };
  EXPECT_THAT(error([&] { (void)root.At("z"); }), HasSubstr("no 'z'; present: a, b, d, e"));
  EXPECT_THAT(error([&] { (void)root.At("b").At("c").Number(); }),
              HasSubstr("t.json: b.c: found string, expected a number"));
  EXPECT_THAT(error([&] { (void)root.At("a").At(7); }), HasSubstr("a: 3 entries"));
  EXPECT_THAT(error([&] { (void)root.At("a").At(1).Integer(); }), HasSubstr("a[1]: found number, expected an integer"));
  EXPECT_THAT(error([&] { (void)root.At("a").Numbers(4); }), HasSubstr("3 numbers, expected 4"));
  EXPECT_THAT(error([&] { (void)root.At("b").Numbers(); }), HasSubstr("b: found object"));
  EXPECT_THAT(error([&] { (void)root.At("a").Text(); }), HasSubstr("expected text"));
  EXPECT_THAT(error([&] { (void)root.At(0); }), HasSubstr("expected an array"));
}

}  // namespace
}  // namespace bodyloom::json_reader_test
