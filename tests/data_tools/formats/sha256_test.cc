// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/sha256.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/support/scratch_folder.h"

namespace bodyloom::sha256_test {
namespace {

std::string DigestOf(std::string_view bytes, size_t piece = 1 << 20) {
  Sha256 sha;
  for (size_t at = 0; at < bytes.size(); at += piece) sha.Add(bytes.substr(at, piece));
  return sha.Hex();
}

// FIPS 180-4's examples (NIST, "SHA256.pdf" of the Cryptographic Standards' examples) and the message of no bytes.
constexpr const char* kOfNothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
constexpr const char* kOfAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
constexpr const char* kOf448Bits = "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1";
constexpr const char* kOfAMillionA = "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";

TEST(Sha256, GivesThePublishedDigests) {
  EXPECT_EQ(DigestOf(""), kOfNothing);
  EXPECT_EQ(DigestOf("abc"), kOfAbc);
  EXPECT_EQ(DigestOf("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"), kOf448Bits);
  EXPECT_EQ(DigestOf(std::string(1'000'000, 'a')), kOfAMillionA);
}

TEST(Sha256, PiecesMakeNoDifference) {
  const std::string million(1'000'000, 'a');
  for (const size_t piece : {1UL, 63UL, 64UL, 65UL, 4096UL}) EXPECT_EQ(DigestOf(million, piece), kOfAMillionA) << piece;
}

TEST(Sha256, FieldsAreToldApart) {
  const auto of = [](const std::vector<std::string>& fields) {
    Sha256 sha;
    for (const std::string& field : fields) sha.AddField(field);
    return sha.Hex();
  };
  EXPECT_NE(of({"ab", "c"}), of({"a", "bc"}));
  EXPECT_NE(of({"abc"}), of({"abc", ""}));
  EXPECT_NE(of({"", "abc"}), of({"abc", ""}));
}

void WriteText(const std::string& path, const std::string& text) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream(path) << text;
}

TEST(Sha256, AFileIsItsContents) {
  const ScratchFolder folder;
  WriteText(folder / "a", "abc");
  WriteText(folder / "long", std::string(1'000'000, 'a'));
  EXPECT_EQ(Sha256OfFile(folder / "a"), kOfAbc);
  EXPECT_EQ(Sha256OfTree(folder / "a"), kOfAbc);
  EXPECT_EQ(Sha256OfFile(folder / "long"), kOfAMillionA);
  EXPECT_THROW(Sha256OfFile(folder / "absent"), std::runtime_error);
  EXPECT_THROW(Sha256OfTree(folder / "absent"), std::runtime_error);
  EXPECT_THROW(Sha256OfFile(folder.path()), std::runtime_error);
}

TEST(Sha256, AFolderIsItsFilesWhereverItLies) {
  const ScratchFolder folder;
  for (const char* place : {"here", "there"}) {
    WriteText(folder / (std::string(place) + "/1.json"), "one");
    WriteText(folder / (std::string(place) + "/sub/2.json"), "two");
  }
  const std::string digest = Sha256OfTree(folder / "here");
  EXPECT_EQ(Sha256OfTree(folder / "there"), digest);
  EXPECT_EQ(Sha256OfTree(folder / "here/"), digest);
  WriteText(folder / "there/1.json", "onf");
  EXPECT_NE(Sha256OfTree(folder / "there"), digest) << "contents";
  WriteText(folder / "there/1.json", "one");
  EXPECT_EQ(Sha256OfTree(folder / "there"), digest);
  std::filesystem::rename(folder / "there/1.json", folder / "there/3.json");
  EXPECT_NE(Sha256OfTree(folder / "there"), digest) << "a name";
}

}  // namespace
}  // namespace bodyloom::sha256_test
