// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/atomic_file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::atomic_file_test {
namespace {

using ::testing::HasSubstr;

size_t FilesIn(const std::string& folder) {
  size_t n = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++n;
  return n;
}

TEST(AtomicFile, WritesAndReplacesWhole) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.bin"), bytes("a\0b\n", 4);
  WriteFileAtomically(path, bytes);
  EXPECT_EQ(ReadFileBytes(path), bytes);
  WriteFileAtomically(path, "");
  EXPECT_EQ(ReadFileBytes(path), "");
  EXPECT_EQ(FilesIn(folder.File("")), 1U) << "no temporary is left";
}

TEST(AtomicFile, FailuresNameThePathAndLeaveWhatStoodThere) {
  const TemporaryFolder folder;
  EXPECT_THAT(FileErrorOf(folder.File("absent/a"), [&] { WriteFileAtomically(folder.File("absent/a"), "x"); }),
              HasSubstr("No such file"));
  std::filesystem::create_directory(folder.File("taken"));
  EXPECT_THAT(FileErrorOf(folder.File("taken"), [&] { WriteFileAtomically(folder.File("taken"), "x"); }),
              HasSubstr("move the finished file into place"));
  EXPECT_EQ(FilesIn(folder.File("")), 1U) << "no temporary is left";
}

TEST(AtomicFile, FullDiskLeavesTheOldFile) {
  const TemporaryFolder folder;
  const std::string path = folder.File("a.bin");
  WriteFileAtomically(path, "old");
  // A limit on file size makes write() fail half-way, as a full disk does.
  rlimit old_limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const rlimit small{1 << 16, old_limit.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message = FileErrorOf(path, [&] { WriteFileAtomically(path, std::string(1 << 20, 'x')); });
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr("65536 of 1048576 bytes written"));
  EXPECT_EQ(ReadFileBytes(path), "old");
  EXPECT_EQ(FilesIn(folder.File("")), 1U) << "no temporary is left";
}

TEST(AtomicFile, ReadingRefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  FileErrorOf(folder.File("absent"), [&] { ReadFileBytes(folder.File("absent")); });
  EXPECT_THAT(FileErrorOf(folder.File(""), [&] { ReadFileBytes(folder.File("")); }), HasSubstr("not a regular file"));
  ASSERT_EQ(::mkfifo(folder.File("pipe").c_str(), 0600), 0);
  EXPECT_THAT(FileErrorOf(folder.File("pipe"), [&] { ReadFileBytes(folder.File("pipe")); }),
              HasSubstr("not a regular file"));
  WriteFileAtomically(folder.File("big"), std::string(100, 'x'));
  EXPECT_THAT(FileErrorOf(folder.File("big"), [&] { ReadFileBytes(folder.File("big"), 99); }),
              HasSubstr("100 bytes, at most 99"));
}

TEST(AtomicPath, TwoThatWriteOneFileDoNotShareATemporary) {
  const TemporaryFolder folder;
  const AtomicPath one(folder.File("a.csv")), other(folder.File("a.csv"));
  EXPECT_NE(one.temporary(), other.temporary());
}

TEST(AtomicPath, CommitMovesAndDestructionCleansUp) {
  const TemporaryFolder folder;
  const std::string path = folder.File("video.mp4");
  {
    const AtomicPath file(path);
    EXPECT_EQ(std::filesystem::path(file.temporary()).extension(), ".mp4") << "encoders choose by extension";
    std::ofstream(file.temporary()) << "half";
  }
  EXPECT_EQ(FilesIn(folder.File("")), 0U);
  AtomicPath file(path);
  EXPECT_THAT(FileErrorOf(path, [&] { file.Commit(); }), HasSubstr("no output was written"));
  std::ofstream(file.temporary()) << "whole";
  file.Commit();
  EXPECT_EQ(ReadFileBytes(path), "whole");
}

}  // namespace
}  // namespace bodyloom::atomic_file_test
