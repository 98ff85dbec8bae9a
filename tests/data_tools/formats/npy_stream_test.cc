// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <numeric>
#include <thread>

#include "data_tools/formats/npy_stream.h"

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/npz.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::npy_stream_test {
namespace {

using ::testing::HasSubstr;

size_t FilesIn(const TemporaryFolder& folder) {
  size_t n = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.File(""))) ++n;
  return n;
}

std::span<const char> Bytes(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

TEST(NpyStream, HoldsWhatWasWrittenInAnyOrderFromAnyThread) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.npy");
  const int n = 40, size = 3 * 5;
  {
    NpyStream stream(path, DType::kF32, {n, 3, 5});
    EXPECT_EQ(stream.record_bytes(), size * sizeof(float));
    std::vector<std::jthread> threads;
    threads.reserve(4);
    for (int k = 0; k < 4; ++k) {
      threads.emplace_back([&stream, k] {
        for (int i = n - 1 - k; i >= 0; i -= 4) {
          std::vector<float> a(6), b(9);
          std::iota(a.begin(), a.end(), 100.0F * i);
          std::iota(b.begin(), b.end(), 100.0F * i + 6);
          const std::vector<std::span<const char>> pieces = {Bytes(a), {}, Bytes(b)};
          stream.Write(i, pieces);
        }
      });
    }
    threads.clear();
    EXPECT_FALSE(std::filesystem::exists(path)) << "nothing is there before it is whole";
    stream.Finish();
  }
  const NdArray array = ReadNpy(path);
  EXPECT_EQ(array.shape, (std::vector<int64_t>{n, 3, 5}));
  const std::vector<float> values = array.ToFloats();
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < size; ++k) ASSERT_EQ(values[i * size + k], 100 * i + k);
  }
  EXPECT_EQ(FilesIn(folder), 1U);
}

TEST(NpyStream, WithoutFinishLeavesNothing) {
  const TemporaryFolder folder;
  const std::vector<float> record(4, 1.0F);
  const std::vector<std::span<const char>> pieces = {Bytes(record)};
  {
    NpyStream stream(folder.File("a.npy"), DType::kF32, {3, 4});
    stream.Write(0, pieces);
    EXPECT_THROW(stream.Finish(), std::invalid_argument);  // two are missing
    EXPECT_THROW(stream.Write(3, pieces), std::invalid_argument);
    EXPECT_THROW(stream.Write(-1, pieces), std::invalid_argument);
    EXPECT_THROW(stream.Write(1, std::vector<std::span<const char>>()), std::invalid_argument);
  }
  EXPECT_EQ(FilesIn(folder), 0U);
  EXPECT_THROW(NpyStream(folder.File("b.npy"), DType::kF32, {}), std::invalid_argument);
  EXPECT_THROW(NpyStream(folder.File("b.npy"), DType::kF32, {int64_t{1} << 40, int64_t{1} << 40}),
               std::invalid_argument);
  EXPECT_THROW(NpyStream(folder.File("b.npy"), DType::kUnicode, {1}), std::invalid_argument);
  EXPECT_THAT(FileErrorOf(folder.File("absent/a.npy"),
                          [&] {
                            NpyStream(folder.File("absent/a.npy"), DType::kF32, {1, 1});
                          }),
              HasSubstr("No such file"));
  EXPECT_EQ(FilesIn(folder), 0U);
}

/// A limit on file size makes writing fail as a full disk does.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(size_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  sighandler_t handler_;
};

TEST(NpyStream, FullDiskIsAnErrorAndNoFile) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.npy");
  const std::vector<float> record(1024, 1.0F);
  const std::vector<std::span<const char>> pieces = {Bytes(record)};
  {  // known from the start
    const FileSizeLimit limit(10000);
    FileErrorOf(path, [&] { NpyStream(path, DType::kF32, {10, 1024}); });
  }
  EXPECT_EQ(FilesIn(folder), 0U);
  {  // only in mid-stream
    NpyStream stream(path, DType::kF32, {10, 1024});
    stream.Write(0, pieces);
    const FileSizeLimit limit(10000);
    EXPECT_THAT(FileErrorOf(path, [&] { stream.Write(5, pieces); }), HasSubstr("record 5 of 10"));
  }
  EXPECT_EQ(FilesIn(folder), 0U);
}

TEST(NpyStream, MayHaveNoRecords) {
  const TemporaryFolder folder;
  NpyStream stream(folder.File("a.npy"), DType::kF16, {0, 33, 4, 4});
  stream.Finish();
  EXPECT_EQ(ReadNpy(folder.File("a.npy")).shape, (std::vector<int64_t>{0, 33, 4, 4}));
}

namespace fs = std::filesystem;

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

}  // namespace bodyloom::npy_stream_test
