// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/weights_file.h"

#include <gmock/gmock.h>

#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/pickle_writer.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::safetensors_test {
namespace {

using pickle_writer::LittleEndian;
using pickle_writer::RawOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string File(const std::string& header, const std::string& data) {
  return LittleEndian(header.size(), 8) + header + data;
}
std::string Entry(const std::string& type, const std::string& shape, int begin, int end) {
  return R"({"dtype":")" + type + R"(","shape":)" + shape + R"(,"data_offsets":[)" + std::to_string(begin) + "," +
         std::to_string(end) + "]}";
}
WeightsFile Read(const std::string& bytes) { return SafetensorsFromBytes(bytes, "w.safetensors"); }
std::string ErrorOf(const std::string& bytes) {
  return FileErrorOf("w.safetensors", [&] { Read(bytes); });
}

std::map<std::string, NdArray> EveryType() {
  std::map<std::string, NdArray> tensors;
  const auto add = [&](DType dtype, size_t item_size, const std::string& bytes) {
    NdArray array;
    array.dtype = dtype;
    array.item_size = item_size;
    array.shape = {static_cast<int64_t>(bytes.size() / item_size)};
    array.bytes = bytes;
    tensors["t" + std::to_string(static_cast<int>(dtype))] = array;
  };
  add(DType::kBool, 1, std::string("\1\0\1", 3));
  add(DType::kU8, 1, "ab");
  add(DType::kI8, 1, "\xff");
  add(DType::kI16, 2, RawOf<int16_t>({-2}));
  add(DType::kI32, 4, RawOf<int32_t>({-3, 4}));
  add(DType::kI64, 8, RawOf<int64_t>({-5}));
  add(DType::kF16, 2, RawOf<uint16_t>({0x3E00}));
  add(DType::kBF16, 2, RawOf<uint16_t>({0x3FC0}));
  add(DType::kF32, 4, RawOf<float>({1.5F}));
  add(DType::kF64, 8, RawOf<double>({2.5}));
  const float matrix[] = {1, 2, 3, 4, 5, 6};
  tensors["conv.weight"] = NdArray::FromFloats(matrix, {2, 3});
  tensors["empty"] = NdArray::FromFloats(matrix, {0, 3});
  tensors["scalar"] = NdArray::FromDouble(7);
  return tensors;
}

TEST(Safetensors, HandWrittenFile) {
  const WeightsFile file = Read(File(R"({"__metadata__":{"format":"pt"},"b":)" + Entry("F32", "[1,2]", 4, 12) +
                                         R"(,"a":)" + Entry("BF16", "[2]", 0, 4) + "}  ",
                                     RawOf<uint16_t>({0x3F80, 0xC040}) + RawOf<float>({4, 5})));
  EXPECT_THAT(file.tensors.at("a").ToDoubles(), ElementsAre(1, -3));
  EXPECT_THAT(file.tensors.at("b").ToDoubles(), ElementsAre(4, 5));
  EXPECT_EQ(file.tensors.at("b").ShapeText(), "1x2");
  EXPECT_EQ(file.metadata.at("format"), "pt");
  EXPECT_TRUE(Read(File("{}", "")).tensors.empty());
}

TEST(Safetensors, WhatIsWrittenComesBack) {
  TemporaryFolder folder;
  const std::string path = folder.File("w.safetensors");
  const auto tensors = EveryType();
  WriteSafetensors(path, tensors, {{"made", "for a test"}});
  const WeightsFile file = ReadWeights(path);
  ASSERT_EQ(file.tensors.size(), tensors.size());
  for (const auto& [name, tensor] : tensors) {
    EXPECT_EQ(file.tensors.at(name).dtype, tensor.dtype) << name;
    EXPECT_EQ(file.tensors.at(name).shape, tensor.shape) << name;
    EXPECT_EQ(file.tensors.at(name).bytes, tensor.bytes) << name;
  }
  EXPECT_EQ(file.metadata.at("made"), "for a test");
  // The data starts at a multiple of 8 and larger elements come first, so that every tensor is aligned.
  const std::string bytes = SafetensorsBytes(tensors);
  EXPECT_EQ(static_cast<unsigned char>(bytes[0]) % 8, 0);
  EXPECT_THAT(bytes.substr(8), StartsWith(R"({"scalar")"));
  EXPECT_EQ(ReadWeights(path, {.widen_halves = true}).tensors.at("t" + std::to_string(int(DType::kBF16))).dtype,
            DType::kF32);
}

TEST(Safetensors, WriterRefusesWhatTheFormatLacks) {
  EXPECT_THROW(SafetensorsBytes({{"x", NdArray::FromString("text")}}), std::invalid_argument);
  EXPECT_THROW(SafetensorsBytes({{"__metadata__", NdArray::FromDouble(1)}}), std::invalid_argument);
  EXPECT_THROW(SafetensorsBytes({{"\xff", NdArray::FromDouble(1)}}), std::invalid_argument);
  NdArray lying = NdArray::FromDouble(1);
  lying.shape = {2};
  EXPECT_THROW(SafetensorsBytes({{"x", lying}}), std::invalid_argument);
}

TEST(Safetensors, TensorsCoverTheDataExactly) {
  const std::string data(16, 'x');
  const auto two = [&](int begin_a, int end_a, int begin_b, int end_b) {
    return File(R"({"a":)" + Entry("U8", "[" + std::to_string(end_a - begin_a) + "]", begin_a, end_a) + R"(,"b":)" +
                    Entry("U8", "[" + std::to_string(end_b - begin_b) + "]", begin_b, end_b) + "}",
                data);
  };
  EXPECT_EQ(Read(two(0, 8, 8, 16)).tensors.size(), 2U);
  EXPECT_EQ(Read(two(8, 16, 0, 8)).tensors.size(), 2U);
  EXPECT_THAT(ErrorOf(two(0, 8, 7, 16)), HasSubstr("overlap"));
  EXPECT_THAT(ErrorOf(two(0, 16, 0, 16)), HasSubstr("overlap"));
  EXPECT_THAT(ErrorOf(two(0, 7, 8, 16)), HasSubstr("a gap"));
  EXPECT_THAT(ErrorOf(two(1, 8, 8, 16)), HasSubstr("a gap"));
  EXPECT_THAT(ErrorOf(two(0, 8, 8, 15)), HasSubstr("1 bytes after the last tensor"));
  EXPECT_THAT(ErrorOf(two(0, 8, 8, 17)), HasSubstr("the file holds 16"));
  EXPECT_THAT(ErrorOf(two(0, 8, 9, 8)), HasSubstr("'b'"));
}

TEST(Safetensors, RefusesLyingHeaders) {
  const auto one = [](const std::string& entry) { return File(R"({"a":)" + entry + "}", "01234567"); };
  EXPECT_EQ(Read(one(Entry("F32", "[2]", 0, 8))).tensors.size(), 1U);
  EXPECT_THAT(ErrorOf(one(Entry("F32", "[3]", 0, 8))),
              HasSubstr("shape 3 of F32 needs 12 bytes, its data_offsets hold 8"));
  EXPECT_THAT(ErrorOf(one(Entry("F32", "[4294967296,4294967296,4294967296]", 0, 8))), HasSubstr("too many"));
  EXPECT_THAT(ErrorOf(one(Entry("F32", "[0,9223372036854775807,9223372036854775807]", 0, 0))), HasSubstr("too many"));
  EXPECT_THAT(ErrorOf(one(Entry("F32", "[-2]", 0, 8))), HasSubstr("shape"));
  EXPECT_THAT(ErrorOf(one(Entry("F32", "[2.0]", 0, 8))), HasSubstr("shape"));
  EXPECT_THAT(ErrorOf(one(Entry("F32", "[18446744073709551615]", 0, 8))), HasSubstr("shape"));
  EXPECT_THAT(ErrorOf(one(Entry("F8_E4M3", "[8]", 0, 8))), HasSubstr("dtype 'F8_E4M3'"));
  EXPECT_THAT(ErrorOf(one(R"({"shape":[2],"data_offsets":[0,8]})")), HasSubstr("dtype"));
  EXPECT_THAT(ErrorOf(one(R"({"dtype":"F32","data_offsets":[0,8]})")), HasSubstr("shape"));
  EXPECT_THAT(ErrorOf(one(R"({"dtype":"F32","shape":[2],"data_offsets":[0]})")), HasSubstr("data_offsets"));
  EXPECT_THAT(ErrorOf(one("[]")), HasSubstr("expected an object"));
  EXPECT_THAT(ErrorOf(one("[[[[[[1]]]]]]")), HasSubstr("nested"));
  const std::string entry = Entry("F32", "[2]", 0, 8);
  EXPECT_THAT(ErrorOf(File(R"({"a":)" + entry + R"(,"a":)" + entry + "}", "01234567")), HasSubstr("'a' occurs twice"));
  EXPECT_THAT(ErrorOf(File(R"({"__metadata__":{"a":1}})", "")), HasSubstr("expected text"));
  EXPECT_THAT(ErrorOf(File(R"({"__metadata__":[]})", "")), HasSubstr("__metadata__"));
  for (const char* broken : {"", "[]", " {}", "{", "{}}", "{\"a\":}", "{\"\xff\":1}", "nul"}) {
    ErrorOf(File(broken, ""));
  }
  ErrorOf(File("{" + std::string(100000, '['), ""));
}

TEST(Safetensors, RefusesHeadersBeyondTheFileOrTheLimit) {
  EXPECT_THAT(ErrorOf(LittleEndian(~uint64_t{0}, 8) + "{}"), HasSubstr("a header of 18446744073709551615 bytes"));
  EXPECT_THAT(ErrorOf(LittleEndian(3, 8) + "{}"), HasSubstr("expected at most 2"));
  const std::string large(100'000'001, ' ');  // NOLINT(bugprone-string-constructor): beyond the limit is meant
  EXPECT_THAT(ErrorOf(File(large, "")), HasSubstr("expected at most 100000000"));
}

TEST(Safetensors, TruncationAtEveryByteIsRefused) {
  const std::string bytes = SafetensorsBytes(EveryType());
  for (size_t length = 0; length < bytes.size(); ++length) ErrorOf(bytes.substr(0, length));
  ErrorOf(bytes + "x");
}

}  // namespace
}  // namespace bodyloom::safetensors_test
