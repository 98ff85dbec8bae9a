// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/mapped_npy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::mapped_npy_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST(MappedNpy, HoldsWhatTheReaderReadsAfterTheFileIsGone) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.npy");
  std::vector<float> values(7 * 5);
  std::iota(values.begin(), values.end(), -3.0F);
  WriteNpy(path, NdArray::FromFloats(values.data(), {7, 5}));
  ASSERT_EQ(ReadNpy(path).ToFloats(), values);
  const MappedNpy mapped(path, DType::kF32);
  fs::remove(path);
  EXPECT_EQ(mapped.shape(), (std::vector<int64_t>{7, 5}));
  const std::span<const float> read = mapped.Values<float>();
  EXPECT_EQ(std::vector<float>(read.begin(), read.end()), values);
}

TEST(MappedNpy, AnEmptyArrayHasNoValues) {
  const TemporaryFolder folder;
  WriteNpy(folder.File("a.npy"), NdArray::FromFloats(nullptr, {0, 4}));
  EXPECT_TRUE(MappedNpy(folder.File("a.npy"), DType::kF32).Values<float>().empty());
}

TEST(MappedNpy, SaysWhatDoesNotFit) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.npy");
  const auto map = [&] { MappedNpy(path, DType::kF16); };
  EXPECT_THAT(FileErrorOf(path, map), HasSubstr("cannot be opened"));
  fs::create_directory(path);
  EXPECT_THAT(FileErrorOf(path, map), HasSubstr("not a file"));
  fs::remove(path);
  WriteFileAtomically(path, "");
  EXPECT_THAT(FileErrorOf(path, map), HasSubstr("not a file with anything in it"));
  WriteFileAtomically(path, "no numpy here");
  EXPECT_THAT(FileErrorOf(path, map), HasSubstr("not a .npy array"));
  const std::vector<float> values(4);
  WriteNpy(path, NdArray::FromFloats(values.data(), {4}));
  EXPECT_THAT(FileErrorOf(path, map), HasSubstr("elements of type '<f4', expected '<f2'"));
  const std::string whole = ReadFileBytes(path);
  WriteFileAtomically(path, whole.substr(0, whole.size() - 3));
  EXPECT_THAT(FileErrorOf(path, map), HasSubstr("16 bytes"));
  for (size_t cut = 0; cut < whole.size(); ++cut) {
    WriteFileAtomically(path, whole.substr(0, cut));
    EXPECT_THROW(MappedNpy(path, DType::kF32), std::runtime_error) << cut;
  }
  std::string shifted = whole;  // a header one byte longer: floats on odd places
  shifted[8] = static_cast<char>(shifted[8] + 1);
  shifted.insert(10, " ");
  WriteFileAtomically(path, shifted);
  EXPECT_EQ(ReadNpy(path).ToFloats(), values);
  EXPECT_THROW(MappedNpy(path, DType::kF32), std::runtime_error);
}

}  // namespace
}  // namespace bodyloom::mapped_npy_test
