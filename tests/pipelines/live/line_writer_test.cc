// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/live_outputs.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "tests/support/scratch_folder.h"

namespace bodyloom::line_writer_test {
namespace {

/// A pipe with a name, and its end for reading.
struct NamedPipe {
  NamedPipe() : path(folder / "pipe") {
    EXPECT_EQ(mkfifo(path.c_str(), 0600), 0);
    reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  }
  ~NamedPipe() {
    if (reader >= 0) close(reader);
  }
  ScratchFolder folder;
  std::string path;
  int reader = -1;
};

TEST(LineWriter, WritesLinesInOrder) {
  const ScratchFolder folder;
  std::string expected;
  LineWriter writer(folder / "lines", WhenFull::kWait);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(writer.Write(std::to_string(i)));
    expected += std::to_string(i) + "\n";
  }
  writer.Finish();
  EXPECT_EQ(ReadFileBytes(folder / "lines"), expected);
  EXPECT_EQ(writer.num_dropped(), 0);
}

TEST(LineWriter, IsNotHeldUpByAReaderThatDoesNotRead) {
  NamedPipe pipe;
  LineWriter writer(pipe.path, WhenFull::kDropOldest);
  const std::string line(10'000, 'x');
  for (int i = 0; i < 2000; ++i) EXPECT_TRUE(writer.Write(line));  // 20 MB, where a pipe holds 64 kB
  EXPECT_GT(writer.num_dropped(), 1000);
  writer.Finish();  // gives up
}

TEST(LineWriter, SaysThatItsReaderIsGone) {
  std::signal(SIGPIPE, SIG_IGN);  // as the command does
  NamedPipe pipe;
  LineWriter writer(pipe.path, WhenFull::kWait);
  close(pipe.reader);
  pipe.reader = -1;
  while (writer.Write("line")) continue;
  EXPECT_THAT([&] { writer.Finish(); },
              testing::ThrowsMessage<std::runtime_error>(pipe.path + ": writing failed (Broken pipe)"));
}

TEST(LineWriter, RefusesAFolder) {
  const ScratchFolder folder;
  EXPECT_THAT([&] { LineWriter(folder.path(), WhenFull::kWait); },
              testing::ThrowsMessage<std::runtime_error>(folder.path() + ": writing failed (Is a directory)"));
}

}  // namespace
}  // namespace bodyloom::line_writer_test
