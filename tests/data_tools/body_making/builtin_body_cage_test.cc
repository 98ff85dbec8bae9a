// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/cage.h"

#include <gtest/gtest.h>

#include <random>

#include "data_tools/body_making/make_builtin_body.h"
#include "data_tools/formats/printable.h"
#include "tests/data_tools/formats/expect_file_error.h"

namespace bodyloom::builtin_body_cage_test {
namespace {

/// The left half of a cube on the mirror plane, with comments, blank lines and DOS line ends.
const char kHalfCube[] =
    "# half a cube\r\n"
    "v a 1 -1 -1\nv b 1 1 -1\nv c 1 1 1\nv d 1 -1 1\r\n\n"
    "v e 0 -1 -1\nv f 0 1 -1 # on the plane\nv g 0.0 1 1\nv h 0 -1 1\n"
    "f side a b c d\nf back e f b a\nf top|top|t2|t2 f g c b\nf front g h d c\nf bottom h e a d\n";

TEST(Cage, MirrorsTheLeftHalf) {
  const Cage cage = ParseCage(kHalfCube, "cube");
  ASSERT_EQ(cage.vertices.rows(), 12);
  EXPECT_EQ(cage.num_left_vertices, 8);
  EXPECT_EQ(cage.num_left_quads, 5);
  EXPECT_EQ(cage.vertex_names[0], "a");
  EXPECT_EQ(cage.vertex_names[8], "a'");
  EXPECT_EQ(cage.mirror, (std::vector<int>{8, 9, 10, 11, 4, 5, 6, 7, 0, 1, 2, 3}));
  EXPECT_EQ(cage.vertices.row(8), Eigen::RowVector3d(-1, -1, -1));
  ASSERT_EQ(cage.quads.size(), 10u);
  EXPECT_EQ(cage.quads[0], (Quad{0, 1, 2, 3}));
  EXPECT_EQ(cage.quads[5], (Quad{11, 10, 9, 8}));
  EXPECT_EQ(cage.child_charts[0], (std::array<std::string, 4>{"side", "side", "side", "side"}));
  EXPECT_EQ(cage.child_charts[2], (std::array<std::string, 4>{"top", "top", "t2", "t2"}));
  EXPECT_EQ(cage.child_charts[7], (std::array<std::string, 4>{"t2", "t2", "top", "top"}));
}

TEST(Cage, MirrorsRows) {
  const Cage cage = ParseCage(kHalfCube, "cube");
  Eigen::MatrixXd rows(8, 6);
  for (int i = 0; i < rows.size(); ++i) rows.data()[i] = i + 1;
  const Eigen::MatrixXd all = MirrorCageRows(cage, rows);
  ASSERT_EQ(all.rows(), 12);
  EXPECT_EQ(all.topRows(8), rows);
  for (int c = 0; c < 6; ++c) EXPECT_EQ(all(9, c), (c % 3 == 0 ? -1 : 1) * rows(1, c));
  EXPECT_THROW(MirrorCageRows(cage, Eigen::MatrixXd::Zero(7, 3)), std::invalid_argument);
  EXPECT_THROW(MirrorCageRows(cage, Eigen::MatrixXd::Zero(8, 4)), std::invalid_argument);
}

TEST(Cage, RefusesBadLines) {
  const std::string good = kHalfCube;
  const auto message_of = [&](const std::string& extra) {
    return FileErrorOf("bad.txt", [&] { ParseCage(good + extra, "bad.txt"); });
  };
  EXPECT_NE(message_of("vt 0 1\n").find("line 16"), std::string::npos);
  for (const char* line :
       {"v x 1 2\n", "v x 1 2 3 4\n", "v x 1 2 nan\n", "v x 1 2 inf\n", "v x 1 2 1e999\n", "v x 1 2 3z\n",
        "v x 1 2 101\n", "v x -0.1 2 3\n", "v a 1 2 3\n", "v x 1 2 3\n", "f side a b c\n", "f side a b c q\n",
        "f side a b c a\n", "f side a b c d\n", "f a|b a b c d\n", "f side a c b d\n"}) {
    message_of(line);
  }
  FileErrorOf("empty.txt", [] { ParseCage("", "empty.txt"); });
  FileErrorOf("binary.txt", [] { ParseCage(std::string("\0\xff\x7f v", 5), "binary.txt"); });
  std::string many;
  for (int i = 0; i < 100'001; ++i) many += "v n" + std::to_string(i) + " 1 1 1\n";
  FileErrorOf("many.txt", [&] { ParseCage(many, "many.txt"); });
}

TEST(Cage, RefusesEveryTruncation) {
  const std::string good = kHalfCube;
  for (size_t size = 0; size + 2 < good.size(); ++size) {
    FileErrorOf("cut.txt", [&] { ParseCage(good.substr(0, size), "cut.txt"); });
  }
  const std::string cage = EmbeddedBuiltinBodySources().cage_text;
  for (size_t size = 0; size + 2 < cage.size(); size += 53) {
    FileErrorOf("cut.txt", [&] { ParseCage(cage.substr(0, size), "cut.txt"); });
  }
}

/// Random edits of bytes: refused with one line, or a cage that holds together.
TEST(Cage, SurvivesRandomEdits) {
  std::mt19937 random(17);
  int refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string text = kHalfCube;
    for (int edit = 0; edit < 1 + trial % 4; ++edit) text[random() % text.size()] = static_cast<char>(random() % 256);
    try {
      const Cage cage = ParseCage(text, "edited.txt");
      EXPECT_EQ(cage.quads.size(), 2u * cage.num_left_quads);
      EXPECT_EQ(cage.vertices.rows(), static_cast<Eigen::Index>(cage.mirror.size()));
      EXPECT_TRUE(cage.vertices.allFinite());
    } catch (const std::runtime_error& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("edited.txt"), std::string::npos);
      EXPECT_TRUE(IsOneLine(error.what())) << error.what();
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 3000);
}

}  // namespace
}  // namespace bodyloom::builtin_body_cage_test
