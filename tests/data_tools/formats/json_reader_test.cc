// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/json_reader.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

TEST(JsonReader, NanOfPythonBecomesNullWhereItIsAllowed) {
  const JsonLimits limits = {.nan_is_null = true};
  const nlohmann::json json = ParseJson(R"([NaN,1,-Infinity , Infinity,"NaN",-2,[NaN]])", "t.json", limits);
  EXPECT_EQ(json, nlohmann::json::parse(R"([null,1,null,null,"NaN",-2,[null]])"));
  const nlohmann::json numbers = ParseJson("[NaN, 1, -Infinity, 2]", "t.json", limits);
  const JsonNode node(numbers, "t.json");
  const std::vector<double> values = node.NumbersOrNan(4);
  EXPECT_TRUE(std::isnan(values[0]) && std::isnan(values[2]));
  EXPECT_EQ(values[3], 2);
  EXPECT_TRUE(std::isnan(node.At(0).NumberOrNan()));
  EXPECT_EQ(node.At(1).NumberOrNan(), 1);
  EXPECT_THAT(FileErrorOf("t.json", [&] { (void)node.Numbers(); }), HasSubstr("found null after 0 numbers"));
  EXPECT_THAT(FileErrorOf("t.json", [&] { (void)node.NumbersOrNan(3); }), HasSubstr("4 numbers, expected 3"));
  // Other words are no numbers, and a fault behind NaN is reported at its own byte, as without them.
  EXPECT_THAT(FileErrorOf("t.json", [&] { ParseJson("[Nan]", "t.json", limits); }), HasSubstr("byte 1"));
  EXPECT_THAT(FileErrorOf("t.json", [&] { ParseJson("[Inf]", "t.json", limits); }), HasSubstr("byte 1"));
  EXPECT_THAT(FileErrorOf("t.json", [&] { ParseJson("[NaN,NaN,-Infinity,x]", "t.json", limits); }),
              HasSubstr("byte 20: not valid"));
  EXPECT_THAT(FileErrorOf("t.json", [&] { ParseJson("[111,222,-33333333,x]", "t.json", limits); }),
              HasSubstr("byte 20: not valid"));
}

TEST(JsonReader, AByteOrderMarkIsPassedOver) {
  EXPECT_EQ(ParseJson("\xEF\xBB\xBF[1]", "t.json"), nlohmann::json::parse("[1]"));
  EXPECT_EQ(ParseJsonLines("\xEF\xBB\xBF[1]\n[2]", "t.json"), nlohmann::json::parse("[[1],[2]]"));
  FileErrorOf("t.json", [&] { ParseJson("\xEF\xBB[1]", "t.json"); });
}

TEST(JsonLines, SeveralValuesAreTheArrayOfThem) {
  const auto parse = [](const std::string& text) {
    std::vector<std::string> warnings;
    nlohmann::json json = ParseJsonLines(text, "l.json", {.nan_is_null = true}, &warnings);
    EXPECT_TRUE(warnings.empty());
    return json;
  };
  const nlohmann::json two = nlohmann::json::parse(R"([{"a":"}\n{"},{"b":[null]}])");
  EXPECT_EQ(parse("{\"a\":\"}\\n{\"}\n{\"b\":[NaN]}\n"), two);
  EXPECT_EQ(parse("  {\"a\":\"}\\n{\"}\r\n\r\n{\"b\":[null]}"), two);
  EXPECT_EQ(parse("[1] [2][]"), nlohmann::json::parse("[[1],[2],[]]"));
  EXPECT_EQ(parse("[1,2]"), nlohmann::json::parse("[1,2]")) << "a single value is itself";
  EXPECT_EQ(parse("7"), nlohmann::json(7));
}

TEST(JsonLines, ACutEndIsLeftOutWithAWarningAndOtherFaultsAreErrors) {
  std::vector<std::string> warnings;
  EXPECT_EQ(ParseJsonLines("{\"a\":1}\n{\"a\":2}\n{\"a\":[3", "l.json", {}, &warnings),
            nlohmann::json::parse(R"([{"a":1},{"a":2}])"));
  EXPECT_THAT(warnings, ElementsAre("l.json: the last of 3 JSON values is cut off and left out"));
  EXPECT_EQ(ParseJsonLines("[1]\n[2", "l.json").size(), 1U) << "without anyone to warn";
  const auto error = [](const std::string& text) {
    return FileErrorOf("l.json", [&] { ParseJsonLines(text, "l.json"); });
  };
  EXPECT_THAT(error("{\"a\":1},{\"a\":2}"), HasSubstr("byte 7: found ',' between two JSON values"));
  EXPECT_THAT(error("[1]\n[2}\n[3]"), HasSubstr("byte"));
  EXPECT_THAT(error("[1]\n[x]\n[3]"), HasSubstr("byte 6: not valid JSON"));
  EXPECT_THAT(error("[1"), HasSubstr("not valid JSON"));
  EXPECT_THAT(error("[1]\n[NaN]"), HasSubstr("byte 5: found NaN"));
  EXPECT_THAT(error("[1] x [2]"), HasSubstr("found 'x'"));
  EXPECT_THAT(error("[1] [2] x"), HasSubstr("found 'x'"));
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
