// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <bit>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "data_tools/formats/npz.h"

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/element_type.h"
#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/zip.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/object_npy_bytes.h"
#include "tests/data_tools/formats/pickle_writer.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::npz_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A .npy file written by hand: `header` as given, then `data`.
std::string Npy(const std::string& header, const std::string& data, int version = 1) {
  std::string bytes("\x93NUMPY", 6);
  bytes +=
      {static_cast<char>(version), 0, static_cast<char>(header.size() & 255), static_cast<char>(header.size() >> 8)};
  if (version > 1) bytes += {0, 0};
  return bytes + header + data;
}

template <typename T>
std::string Raw(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  return bytes;
}

std::string NpzOf(const std::string& name, const std::string& npy) { return MakeZip({{name + ".npy", npy}}); }

TEST(Npy, ReadsEveryNumberType) {
  const auto read = [](const std::string& descr, const std::string& data) {
    return ReadNpyBytes(Npy("{'descr': '" + descr + "', 'fortran_order': False, 'shape': (2,), }\n", data), "x.npy")
        .ToDoubles();
  };
  EXPECT_THAT(read("|b1", Raw<uint8_t>({0, 1})), ElementsAre(0, 1));
  EXPECT_THAT(read("|i1", Raw<int8_t>({-128, 127})), ElementsAre(-128, 127));
  EXPECT_THAT(read("|u1", Raw<uint8_t>({0, 255})), ElementsAre(0, 255));
  EXPECT_THAT(read("<i2", Raw<int16_t>({-300, 300})), ElementsAre(-300, 300));
  EXPECT_THAT(read("<u2", Raw<uint16_t>({1, 65535})), ElementsAre(1, 65535));
  EXPECT_THAT(read("<i4", Raw<int32_t>({-70000, 7})), ElementsAre(-70000, 7));
  EXPECT_THAT(read("<u4", Raw<uint32_t>({4294967295U, 7})), ElementsAre(4294967295.0, 7));
  EXPECT_THAT(read("<i8", Raw<int64_t>({-5000000000, 7})), ElementsAre(-5e9, 7));
  EXPECT_THAT(read("<u8", Raw<uint64_t>({5000000000, 7})), ElementsAre(5e9, 7));
  EXPECT_THAT(read("<f4", Raw<float>({1.5F, -2})), ElementsAre(1.5, -2));
  EXPECT_THAT(read("<f8", Raw<double>({1e300, -2})), ElementsAre(1e300, -2));
  EXPECT_THAT(read(">i2", std::string("\x01\x02\xff\xff", 4)), ElementsAre(258, -1));
  EXPECT_THAT(read(">f8", std::string("\x3f\xf8\0\0\0\0\0\0\xc0\0\0\0\0\0\0\0", 16)), ElementsAre(1.5, -2));
}

TEST(Npy, ReadsHalfPrecision) {
  // Values from the IEEE 754 binary16 encoding: 1, smallest subnormal, largest finite, -inf, NaN.
  const NdArray array = ReadNpyBytes(Npy("{'descr': '<f2', 'fortran_order': False, 'shape': (5,), }",
                                         Raw<uint16_t>({0x3c00, 0x0001, 0x7bff, 0xfc00, 0x7e00})),
                                     "x.npy");
  const std::vector<double> values = array.ToDoubles();
  EXPECT_EQ(values[0], 1);
  EXPECT_EQ(values[1], std::ldexp(1.0, -24));
  EXPECT_EQ(values[2], 65504);
  EXPECT_EQ(values[3], -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(values[4]));
}

TEST(Npy, FortranOrderBecomesC) {
  // a[i, j, k] = 100 i + 10 j + k of shape 2x3x2 in Fortran order.
  std::string data;
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 2; ++i) data += Raw<int32_t>({100 * i + 10 * j + k});
    }
  }
  const NdArray array =
      ReadNpyBytes(Npy("{'descr': '<i4', 'fortran_order': True, 'shape': (2, 3, 2), }", data), "x.npy");
  EXPECT_THAT(array.ToInts(), ElementsAre(0, 1, 10, 11, 20, 21, 100, 101, 110, 111, 120, 121));
  EXPECT_EQ(array.ShapeText(), "2x3x2");
  EXPECT_EQ(array.ToMatrix().rows(), 2);
  EXPECT_EQ(array.ToMatrix()(1, 5), 121);
}

TEST(Npy, ReadsTextAndScalars) {
  const NdArray bytes =
      ReadNpyBytes(Npy("{'descr': '|S6', 'fortran_order': False, 'shape': (), }", std::string("male\0\0", 6)), "x.npy");
  EXPECT_THAT(bytes.ToStrings(), ElementsAre("male"));
  EXPECT_EQ(bytes.ShapeText(), "scalar");
  const NdArray text = ReadNpyBytes(Npy("{'descr': '<U3', 'fortran_order': False, 'shape': (2,), }",
                                        Raw<uint32_t>({0xe9, 0x20ac, 0x1F600, 'a', 0, 0})),
                                    "x.npy");
  EXPECT_THAT(text.ToStrings(), ElementsAre("\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80", "a"));
  EXPECT_THROW((void)text.ToDoubles(), std::invalid_argument);
  const NdArray big =
      ReadNpyBytes(Npy("{'descr': '>U1', 'fortran_order': False, 'shape': (), }", std::string("\0\0\0a", 4)), "x.npy");
  EXPECT_THAT(big.ToStrings(), ElementsAre("a"));
}

TEST(Npy, ReadsHeaderVersions2And3AndPython2Longs) {
  const std::string header = "{'shape': (2L, 1L), 'fortran_order': False, 'descr': '<f8'}";
  for (const int version : {1, 2, 3}) {
    EXPECT_THAT(ReadNpyBytes(Npy(header, Raw<double>({3, 4}), version), "x.npy").ToDoubles(), ElementsAre(3, 4));
  }
}

TEST(Npy, RefusesLyingHeaders) {
  const std::string data = Raw<double>({1, 2});
  const auto refuse = [&](const std::string& header, const std::string& expected) {
    const std::string message = FileErrorOf("x.npy", [&] { ReadNpyBytes(Npy(header, data), "x.npy"); });
    EXPECT_THAT(message, HasSubstr(expected));
  };
  refuse("{'descr': '<f8', 'fortran_order': False, 'shape': (536870912,), }", "4294967296 bytes");
  refuse("{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }", "24 bytes");
  refuse("{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }", "8 bytes");
  refuse("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999, 99999999999, 99999999999), }", "promises");
  refuse("{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296), }", "promises");
  refuse("{'descr': '<f8', 'fortran_order': False, 'shape': (9999999999999999999999,), }", "10^18");
  refuse("{'descr': '<f8', 'fortran_order': False, 'shape': (-2,), }", "whole number");
  refuse("{'descr': '<f8', 'fortran_order': False, 'shape': (2,)", "'}'");
  refuse("{'descr': '<f8', 'fortran_order': False}", "shape");
  refuse("{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", "once");
  refuse("{'descr': '<f8', 'fortran_order': 1, 'shape': (2,), }", "True or False");
  refuse("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), 'run': 'me'}", "run");
  refuse("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), } + 1", "nothing after");
  refuse("{'descr': '<f8", "closing quote");
  refuse("{'descr': '|O', 'fortran_order': False, 'shape': (2,), }", "never read");
  refuse("{'descr': '<c16', 'fortran_order': False, 'shape': (1,), }", "never read");
  refuse("{'descr': [('a', '<f4'), ('b', '<i4')], 'fortran_order': False, 'shape': (2,), }", "never read");
  refuse("{'descr': [('a', '<f4', 'fortran_order': False, 'shape': (2,), }", "']'");
  refuse("{'descr': '<U0', 'fortran_order': False, 'shape': (999999999999,), }", "promises");
  refuse(std::string(70000, ' '), "");
}

TEST(Npy, RefusesEveryTruncation) {
  const std::string whole = Npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", Raw<double>({1, 2}));
  for (size_t n = 0; n < whole.size(); ++n) {
    FileErrorOf("x.npy", [&] { ReadNpyBytes(whole.substr(0, n), "x.npy"); });
  }
}

NpzArrays Sample() {
  NpzArrays arrays;
  std::vector<double> poses(6 * 72);
  std::iota(poses.begin(), poses.end(), 0.25);
  arrays["poses"] = NdArray::FromDoubles(poses.data(), {6, 72});
  const std::vector<float> betas = {1, -2, 3};
  arrays["betas"] = NdArray::FromFloats(betas.data(), {3});
  arrays["gender"] = NdArray::FromString("neutral");
  arrays["names"] = NdArray::FromStrings({"hip", "", "fu\xc3\x9f"});
  arrays["rate"] = NdArray::FromDouble(60);
  const std::vector<uint8_t> status = {0, 3};
  arrays["status"] = NdArray::FromUInt8(status.data(), {2});
  arrays["none"] = NdArray::FromDoubles(nullptr, {0, 3});
  return arrays;
}

TEST(Npz, RoundTripIsExactAndDeterministic) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.npz"), again = folder.File("b.npz");
  const NpzArrays arrays = Sample();
  WriteNpz(path, arrays);
  const NpzArrays read = ReadNpz(path);
  ASSERT_EQ(read.size(), arrays.size());
  for (const auto& [name, array] : arrays) {
    const NdArray& other = RequireArray(read, name, path);
    EXPECT_EQ(other.dtype, array.dtype) << name;
    EXPECT_EQ(other.shape, array.shape) << name;
    EXPECT_EQ(other.bytes, array.bytes) << name;
  }
  EXPECT_THAT(read.at("names").ToStrings(), ElementsAre("hip", "", "fu\xc3\x9f"));
  WriteNpz(again, read);
  EXPECT_EQ(ReadFileBytes(path), ReadFileBytes(again));
}

TEST(Npz, SingleArrayFileRoundTripAligned) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.npy");
  const std::vector<double> values = {1, 2, 3, 4, 5, 6};
  WriteNpy(path, NdArray::FromDoubles(values.data(), {3, 2}));
  EXPECT_EQ(ReadNpy(path).ToDoubles(), values);
  EXPECT_EQ((ReadFileBytes(path).size() - 48) % 64, 0U) << "data must start at a multiple of 64 bytes";
}

TEST(Npz, MissingArrayListsWhatIsThere) {
  const NpzArrays arrays = Sample();
  const std::string message = FileErrorOf("track.npz", [&] { RequireArray(arrays, "trans", "track.npz"); });
  EXPECT_THAT(message, HasSubstr("'trans'"));
  EXPECT_THAT(message, HasSubstr("betas, gender"));
}

TEST(Npz, ObjectArrayBesideOthersIsCarriedButNeverRead) {
  const std::string object = Npy("{'descr': '|O', 'fortran_order': False, 'shape': (), }", "\x80\x02cos\nsystem\n.");
  const std::string plain = Npy("{'descr': '<f8', 'fortran_order': False, 'shape': (), }", Raw<double>({7}));
  const NpzArrays arrays =
      ReadNpzBytes(MakeZip({{"part2num.npy", object}, {"x.npy", plain}, {"notes.txt", "hi"}}), "m.npz");
  EXPECT_EQ(RequireArray(arrays, "x", "m.npz").ToDoubles().front(), 7);
  EXPECT_EQ(arrays.at("part2num").dtype, DType::kOther);
  EXPECT_THAT(FileErrorOf("m.npz", [&] { RequireArray(arrays, "part2num", "m.npz"); }), HasSubstr("never read"));
  EXPECT_THROW((void)arrays.at("part2num").ToDoubles(), std::invalid_argument);
}

TEST(Npz, AnObjectThatIsANumberOrTextIsThat) {
  const NpzArrays arrays =
      ReadNpzBytes(MakeZip({{"rate.npy", ObjectNpyBytes(pickle_writer::Int(120))},
                            {"half.npy", ObjectNpyBytes(std::string("G\x3f\xe0\0\0\0\0\0\0", 9), "(1,)")},
                            {"gender.npy", ObjectNpyBytes(pickle_writer::Unicode("female"))},
                            {"table.npy", ObjectNpyBytes(pickle_writer::Dict({}))},
                            {"two.npy", ObjectNpyBytes(pickle_writer::Int(1) + pickle_writer::Int(2), "(2,)")},
                            {"none.npy", ObjectNpyBytes("N")}}),
                   "m.npz");
  EXPECT_EQ(RequireArray(arrays, "rate", "m.npz").ToDoubles(), std::vector<double>{120});
  EXPECT_EQ(RequireArray(arrays, "half", "m.npz").ToDoubles(), std::vector<double>{0.5});
  EXPECT_EQ(RequireArray(arrays, "gender", "m.npz").ToStrings(), std::vector<std::string>{"female"});
  for (const char* name : {"table", "two", "none"}) EXPECT_EQ(arrays.at(name).dtype, DType::kOther) << name;
}

TEST(Npz, RefusesEveryTruncation) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.npz");
  WriteNpz(path, Sample());
  const std::string whole = ReadFileBytes(path);
  for (size_t n = 0; n < whole.size(); ++n) {
    FileErrorOf("a.npz", [&] { ReadNpzBytes(whole.substr(0, n), "a.npz"); });
  }
}

TEST(Npz, DetectsEveryFlippedDataByte) {
  const std::string npy = Npy("{'descr': '<f8', 'fortran_order': False, 'shape': (4,), }", Raw<double>({1, 2, 3, 4}));
  const std::string whole = NpzOf("x", npy);
  const size_t begin = 30 + 5;  // member header and the name "x.npy"
  const size_t end = whole.find("PK\x01\x02");
  ASSERT_GT(end, begin + 20);
  for (size_t i = begin; i < end; ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x01);
    FileErrorOf("a.npz", [&] { ReadNpzBytes(damaged, "a.npz"); });
  }
}

TEST(Zip, PiecesMakeTheMemberThatTheirSumMakes) {
  std::string noise(700000, '\0'), text;
  uint32_t state = 1;
  for (char& c : noise) c = static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
  for (int64_t i = 0; i < 90000; ++i) text += std::to_string(i * i) + " ";
  for (const std::string& whole : {noise, text, std::string()}) {
    const std::string_view all = whole;
    const size_t cut = all.size() / 3;
    const std::array<std::string_view, 4> pieces = {all.substr(0, cut), "", all.substr(cut, 1),
                                                    all.substr(std::min(cut + 1, all.size()))};
    ZipBuilder zip;
    zip.Add("member", pieces);
    const std::string archive = std::move(zip).Finish();
    EXPECT_EQ(archive, MakeZip({{"member", whole}}));
    EXPECT_EQ(ReadZip(archive, "here", 1 << 24).at(0).bytes, whole);
    EXPECT_EQ(archive.size() > whole.size(), whole != text);
  }
}

TEST(Npz, RefusesZipBombs) {
  // 64 MiB of zeros deflate to 64 KiB: allowed by ratio, refused by the caller's limit.
  const std::string bomb = MakeZip({{"x.npy", std::string(size_t{64} << 20, '\0')}});
  EXPECT_THAT(FileErrorOf("a.npz", [&] { ReadNpzBytes(bomb, "a.npz", size_t{1} << 20); }),
              HasSubstr("at most 1048576"));
  // A directory entry that promises 4 GB out of 64 KiB of packed bytes.
  std::string lying = bomb;
  const size_t entry = lying.rfind("PK\x01\x02");
  for (int i = 0; i < 4; ++i) lying[entry + 24 + i] = static_cast<char>(i == 3 ? 0xF0 : 0x00);
  EXPECT_THAT(FileErrorOf("a.npz", [&] { ReadNpzBytes(lying, "a.npz"); }), HasSubstr("more than deflate can give"));
}

TEST(Npz, RefusesSharedPackedBytes) {
  // Two directory entries that point at the same member: one compressed stream would be unpacked many times.
  std::string archive = MakeZip({{"a.npy", std::string(100, 'x')}, {"b.npy", std::string(100, 'x')}});
  const size_t first = archive.find("PK\x01\x02"), second = archive.find("PK\x01\x02", first + 4);
  std::memcpy(&archive[second + 42], &archive[first + 42], 4);
  EXPECT_THAT(FileErrorOf("a.npz", [&] { ReadNpzBytes(archive, "a.npz"); }), HasSubstr("overlap"));
}

TEST(Npz, ReadsZip64AndStreamedMembers) {
  // A member as numpy.savez writes it: sizes in a zip64 record of the member header; here the directory uses one too.
  const std::string npy = Npy("{'descr': '<f8', 'fortran_order': False, 'shape': (), }", Raw<double>({42}));
  const std::string plain = MakeZip({{"x.npy", npy}});
  const size_t entry = plain.find("PK\x01\x02"), end = plain.find("PK\x05\x06");
  std::string record = Raw<uint16_t>({1, 16});
  uint64_t size = 0, packed = 0;
  std::memcpy(&packed, &plain[entry + 20], 4);
  std::memcpy(&size, &plain[entry + 24], 4);
  record += Raw<uint64_t>({size, packed});
  std::string directory = plain.substr(entry, end - entry) + record;
  for (int i = 20; i < 28; ++i) directory[i] = '\xff';
  directory[30] = static_cast<char>(record.size());
  std::string zip64 = "PK\x06\x06" + Raw<uint64_t>({44}) + Raw<uint16_t>({45, 45}) + Raw<uint32_t>({0, 0}) +
                      Raw<uint64_t>({1, 1, directory.size(), entry}) + "PK\x06\x07" + Raw<uint32_t>({0}) +
                      Raw<uint64_t>({entry + directory.size()}) + Raw<uint32_t>({1});
  const std::string last = "PK\x05\x06" + std::string(4, '\0') + std::string(12, '\xff') + std::string(2, '\0');
  const std::string archive = plain.substr(0, entry) + directory + zip64 + last;
  EXPECT_EQ(ReadNpzBytes(archive, "a.npz").at("x").ToDoubles().front(), 42);
  for (size_t n = 0; n < archive.size(); ++n) {
    FileErrorOf("a.npz", [&] { ReadNpzBytes(archive.substr(0, n), "a.npz"); });
  }
}

TEST(Npz, FileErrorsNameTheFile) {
  FileErrorOf("/nonexistent/x.npz", [] { ReadNpz("/nonexistent/x.npz"); });
  EXPECT_THAT(FileErrorOf("x.npz", [] { ReadNpzBytes(std::string(500, 'a'), "x.npz"); }),
              HasSubstr("expected a zip archive"));
}

TEST(ElementType, ParsesOnlyPlainTypes) {
  EXPECT_EQ(ParseElementType(">i4")->big_endian, true);
  EXPECT_EQ(ParseElementType("<U12")->item_size, 48U);
  for (const char* text :
       {"", "<", "<f", "<f16", "<c8", "|O", "|V8", "<M8[ns]", "f8x", "<i3", "<U99999999999", "<f-8"}) {
    EXPECT_FALSE(ParseElementType(text).has_value()) << text;
  }
}

// By the definition, for every number there is: (−1)^s · 2^(e − 15) · (1 + f / 1024), without the 1 for e = 0.
TEST(Half, EveryValue) {
  for (uint32_t bits = 0; bits < 65536; ++bits) {
    const auto exponent = static_cast<int>(bits >> 10 & 31), fraction = static_cast<int>(bits & 1023);
    const float value = FloatFromHalf(static_cast<uint16_t>(bits));
    if (exponent == 31 && fraction != 0) {
      EXPECT_TRUE(std::isnan(value)) << bits;
      continue;
    }
    double expected = std::ldexp((exponent == 0 ? 0 : 1) + fraction / 1024.0, std::max(exponent, 1) - 15);
    if (exponent == 31) expected = HUGE_VAL;
    if (bits >= 32768) expected = -expected;
    EXPECT_EQ(std::bit_cast<uint32_t>(value), std::bit_cast<uint32_t>(static_cast<float>(expected))) << bits;
  }
}

}  // namespace

}  // namespace bodyloom::npz_test
