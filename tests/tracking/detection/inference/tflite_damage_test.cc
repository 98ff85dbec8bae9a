// SPDX-License-Identifier: Apache-2.0
/// Truncated, modified and foreign files: read or rejected in one line, without out-of-bounds access.
#include "tracking/detection/inference/tflite_reader.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "data_tools/formats/printable.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/tracking/detection/inference/small_networks.h"
#include "tests/tracking/detection/inference/tflite_writer.h"

namespace bodyloom::tflite_damage_test {
namespace {

using Writer = TfliteWriter;

TEST(TfliteReader, OtherFilesAreRefused) {
  for (const std::string& bytes : {std::string(), std::string("TFL3"), std::string(100, '\0'),
                                   std::string("\x08\0\0\0TFL2", 8), std::string("\xFF\xFF\xFF\xFFTFL3", 8),
                                   std::string("\x08\0\0\0TFL3", 8), std::string("\x08\0\0\0TFL3\x04\0\0\0", 12)}) {
    FileErrorOf("other.tflite", [&] { ParseTfliteGraph(bytes, "other.tflite"); });
  }
}

/// Reads copies of exactly as many bytes, so that a sanitizer sees every byte too many.
void ExpectReadOrRefused(const std::string& bytes, int* accepted) {
  const std::vector<char> exact(bytes.begin(), bytes.end());
  try {
    ParseTfliteGraph({exact.data(), exact.size()}, "cut.tflite");
    ++*accepted;
  } catch (const std::runtime_error& error) {
    ASSERT_EQ(std::string(error.what()).rfind("cut.tflite: ", 0), 0U) << error.what();
    ASSERT_TRUE(IsOneLine(error.what())) << error.what();
  }
}

TEST(TfliteReader, CutAnywhere) {
  for (const Writer& writer : SmallNetworks()) {
    const std::string bytes = writer.Bytes();
    int accepted = 0;
    for (size_t length = 0; length < bytes.size(); ++length) {
      ASSERT_NO_FATAL_FAILURE(ExpectReadOrRefused(bytes.substr(0, length), &accepted)) << length;
    }
    EXPECT_EQ(accepted, 0);
  }
}

TEST(TfliteReader, EveryByteChanged) {
  for (const Writer& writer : SmallNetworks()) {
    const std::string bytes = writer.Bytes();
    int accepted = 0;
    for (size_t at = 0; at < bytes.size(); ++at) {
      for (const int value : {0x00, 0x7F, 0xFF}) {
        std::string changed = bytes;
        changed[at] = static_cast<char>(value);
        ASSERT_NO_FATAL_FAILURE(ExpectReadOrRefused(changed, &accepted)) << at;
      }
    }
    EXPECT_GT(accepted, 0);
    EXPECT_LT(accepted, static_cast<int>(3 * bytes.size()));
  }
}

TEST(TfliteReader, ManyBytesChanged) {
  std::mt19937 random(4);
  int accepted = 0;
  for (const Writer& writer : SmallNetworks()) {
    const std::string bytes = writer.Bytes();
    for (int i = 0; i < 5000; ++i) {
      std::string changed = bytes;
      for (unsigned n = 1 + random() % 4; n > 0; --n) {
        const size_t at = random() % (bytes.size() / 4) * 4;
        const auto value = static_cast<uint32_t>(random() % 2 == 0 ? random() : random() % bytes.size());
        std::memcpy(changed.data() + at, &value, sizeof(value));
      }
      ASSERT_NO_FATAL_FAILURE(ExpectReadOrRefused(changed, &accepted)) << i;
    }
  }
  EXPECT_GT(accepted, 100);
  EXPECT_LT(accepted, 14900);
}

}  // namespace
}  // namespace bodyloom::tflite_damage_test
