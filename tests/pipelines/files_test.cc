// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "pipelines/files.h"

#include "geometry/base/callbacks.h"

namespace bodyloom::files_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class Files : public ::testing::Test {
 protected:
  Files() : folder_(fs::temp_directory_path() / ("bodyloom_files_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(InFolder("there")) << "content";
  }
  ~Files() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string InFolder(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] int NumEntries() const {
    return static_cast<int>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

TEST_F(Files, ReadableOnesPass) {
  EXPECT_NO_THROW(RequireReadable(InFolder("there"), "detections"));
  EXPECT_NO_THROW(RequireReadable(folder_.string(), "detections"));
  EXPECT_NO_THROW(RequireReadable("", "not given"));
}

TEST_F(Files, AMissingOneIsNamed) {
  EXPECT_THAT([&] { RequireReadable(InFolder("absent"), "detections"); },
              ThrowsMessage<std::runtime_error>(
                  ::testing::AllOf(HasSubstr(InFolder("absent") + ": No such file"), HasSubstr("(detections)"))));
}

TEST_F(Files, WritableLeavesEverythingAsItWas) {
  EXPECT_NO_THROW(RequireWritable(InFolder("new")));
  EXPECT_NO_THROW(RequireWritable(InFolder("there")));
  EXPECT_EQ(NumEntries(), 1);
  std::string content;
  std::ifstream(InFolder("there")) >> content;
  EXPECT_EQ(content, "content");
}

TEST_F(Files, WhatCannotBeWrittenIsNamed) {
  EXPECT_THAT([&] { RequireWritable(InFolder("absent/file")); },
              ThrowsMessage<std::runtime_error>(HasSubstr(InFolder("absent/file") + ": cannot be written")));
  EXPECT_THAT([&] { RequireWritable(folder_.string()); }, ThrowsMessage<std::runtime_error>(HasSubstr("is a folder")));
  EXPECT_THROW(RequireWritable("/dev/null"), std::runtime_error);
  EXPECT_THROW(RequireWritable("/proc/file"), std::runtime_error);
}

TEST_F(Files, FoldersAreMade) {
  EXPECT_NO_THROW(RequireWritableFolder(InFolder("a/b")));
  EXPECT_TRUE(fs::is_directory(InFolder("a/b")));
  EXPECT_TRUE(fs::is_empty(InFolder("a/b")));
  EXPECT_THAT([&] { RequireWritableFolder(InFolder("there")); },
              ThrowsMessage<std::runtime_error>(HasSubstr("cannot be made a folder")));
}

TEST_F(Files, ReadingAndWritingTheSameFileIsAMistake) {
  EXPECT_NO_THROW(RequireDistinct({"a", ""}, {"b", "", "c", ""}));
  EXPECT_THROW(RequireDistinct({InFolder("there")}, {InFolder("x/../there")}), RequestError);
  EXPECT_THROW(RequireDistinct({}, {"a", "b", "./a"}), RequestError);
}

TEST(PeakMemory, IsThatOfAProcess) {
  EXPECT_GT(PeakMemoryBytes(), size_t{1} << 20);
  EXPECT_LT(PeakMemoryBytes(), size_t{1} << 36);
}

}  // namespace

}  // namespace bodyloom::files_test
