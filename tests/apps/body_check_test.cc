// SPDX-License-Identifier: Apache-2.0
// `bodyloom body info --check` on damaged copies of the built-in body.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <random>

#include "apps/usage_error.h"
#include "data_tools/body/body_io.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/track_io.h"
#include "geometry/mesh/mesh_check.h"
#include "tests/support/run_command.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/short_track.h"

namespace bodyloom::body_check_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class BodyCheck : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_ / name; }
  std::string Save(const std::string& name, const BodyModelData& body) const {
    SaveBodyCompact(Path(name), body);
    return Path(name);
  }
  static CommandResult Check(const std::string& body, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"body", "info", "--check", "--quiet"};
    if (!body.empty()) arguments.push_back(body);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunCommand(arguments);
  }

 private:
  ScratchFolder folder_;
};

BodyModelData WithTurnedAndDoubledFaces() {
  BodyModelData body = BuiltinBody().data();
  for (const int f : {10, 11, 12}) {
    std::swap(body.faces(f, 1), body.faces(f, 2));
    std::swap(body.ft(f, 1), body.ft(f, 2));
    for (int c = 0; c < 2; ++c) std::swap(body.face_iuv(f, 2 + c), body.face_iuv(f, 4 + c));
  }
  const Eigen::Index F = body.faces.rows();
  body.faces.conservativeResize(F + 1, 3), body.ft.conservativeResize(F + 1, 3);
  body.face_iuv.conservativeResize(F + 1, 6);
  body.faces.row(F) = body.faces.row(500).eval(), body.ft.row(F) = body.ft.row(500).eval();
  body.face_iuv.row(F) = body.face_iuv.row(500).eval();
  body.face_part.push_back(body.face_part[500]);
  return body;
}

BodyModelData WithoutItsLastFace() {
  BodyModelData body = BuiltinBody().data();
  const Eigen::Index F = body.faces.rows() - 1;
  body.faces.conservativeResize(F, 3), body.ft.conservativeResize(F, 3), body.face_iuv.conservativeResize(F, 6);
  body.face_part.pop_back();
  return body;
}

TEST_F(BodyCheck, FindsNothingOnTheBuiltInBody) {
  const CommandResult result = Check("");
  EXPECT_EQ(result.exit_code, kExitOk) << result.err;
  EXPECT_THAT(result.out, HasSubstr("vertices         7874\n"));
  EXPECT_THAT(result.out, HasSubstr("\nnothing found\n"));
  EXPECT_THAT(RunCommand({"body", "info"}).out, Not(HasSubstr("nothing found")));
}

TEST_F(BodyCheck, ADamagedBodyIsFoundAndMended) {
  const std::string damaged = Save("damaged.npz", WithTurnedAndDoubledFaces());
  const CommandResult found = Check(damaged);
  EXPECT_EQ(found.exit_code, kExitFailed);
  EXPECT_EQ(found.NumErrorLines(), 1) << found.err;
  EXPECT_THAT(found.err, HasSubstr("damaged.npz: the mesh has faults of 2 kinds"));
  EXPECT_THAT(found.out, HasSubstr("faces that face the wrong way       3  faces 10, 11, 12"));
  EXPECT_THAT(found.out, HasSubstr("faces with the vertices of another  1  faces 15744"));

  const CommandResult mended = Check(damaged, {"--repair", Path("mended.npz")});
  EXPECT_EQ(mended.exit_code, kExitOk) << mended.err;
  EXPECT_THAT(mended.out, HasSubstr("mended: 3 faces turned, 1 faces dropped\n"));
  EXPECT_THAT(mended.out, HasSubstr("nothing left\n"));
  const BodyModelData body = LoadBodyData(Path("mended.npz"));
  EXPECT_TRUE(CheckMesh(body.v_template, body.faces).IsClean());
  EXPECT_EQ(body.faces, BuiltinBody().data().faces);
  EXPECT_EQ(body.ft, BuiltinBody().data().ft);
  EXPECT_EQ(Check(Path("mended.npz")).exit_code, kExitOk);
}

TEST_F(BodyCheck, AHoleIsFilledByCgal) {
  const std::string hole = Save("hole.npz", WithoutItsLastFace());
  const std::vector<std::string> to_stay = {"--repair", Path("out.npz"), "--max-hole", "2"};
  const CommandResult stays = Check(hole, to_stay);
  EXPECT_EQ(stays.exit_code, kExitFailed);
  EXPECT_THAT(stays.out, HasSubstr("mended: nothing\nleft:\n  holes (boundary loops)  1  of 3 edges"));
  EXPECT_TRUE(std::filesystem::exists(Path("out.npz")));
  const CommandResult filled = Check(hole, {"--repair", Path("out.npz")});
  if (!BODYLOOM_HAS_CGAL) {
    EXPECT_EQ(filled.exit_code, kExitFailed);
    EXPECT_THAT(filled.out, HasSubstr("crossing faces: not looked for; holes: not filled (bodyloom-cgal is not"));
    return;
  }
  EXPECT_EQ(filled.exit_code, kExitOk) << filled.err;
  EXPECT_THAT(filled.out, HasSubstr("mended: 1 holes filled\nnothing left\n"));
  const BodyModelData& whole = BuiltinBody().data();
  const BodyModelData body = LoadBodyData(Path("out.npz"));
  ASSERT_EQ(body.faces.rows(), whole.faces.rows());
  EXPECT_EQ(body.faces.topRows(15743), whole.faces.topRows(15743));
  EXPECT_EQ(body.face_part, whole.face_part);
  int turn = 0;  // the corner that the new face begins with
  while (turn < 3 && body.faces(15743, 0) != whole.faces(15743, turn)) ++turn;
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(body.faces(15743, k), whole.faces(15743, (turn + k) % 3));
    EXPECT_EQ(body.ft(15743, k), whole.ft(15743, (turn + k) % 3));
  }
}

/// A body of boxes on one joint.
BodyModelData Boxes(const std::vector<Eigen::AlignedBox3d>& boxes) {
  constexpr int kFaces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const auto n = static_cast<int>(boxes.size());
  BodyModelData body;
  body.name = "boxes";
  body.parents = {-1};
  body.v_template.resize(8 * n, 3);
  body.faces.resize(12 * n, 3);
  body.shapedirs.resize(24 * n, 0);
  body.weights = SparseRows(8 * n, 1);
  body.J_regressor = SparseRows(1, 8 * n);
  for (int i = 0; i < n; ++i) {
    for (int v = 0; v < 8; ++v) {
      const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(v);
      body.v_template.row(8 * i + v) = boxes[i].corner(corner).transpose();
      body.weights.coeffRef(8 * i + v, 0) = 1;
      body.J_regressor.coeffRef(0, 8 * i + v) = 1.0 / (8 * n);
    }
    for (int f = 0; f < 12; ++f) {
      for (int k = 0; k < 3; ++k) body.faces(12 * i + f, k) = 8 * i + kFaces[f][k];
    }
  }
  return body;
}

const Eigen::AlignedBox3d kCube(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.2, 0.2, 0.2));  // 8 litres

TEST_F(BodyCheck, ACubeWithoutASideIsACubeAgain) {
  BodyModelData open = Boxes({kCube});
  open.faces.conservativeResize(10, 3);  // without the side x = 0.2
  for (int f = 0; f < 5; ++f) std::swap(open.faces(f, 1), open.faces(f, 2));
  const CommandResult result = Check(Save("open.npz", open), {"--repair", Path("closed.npz")});
  EXPECT_THAT(result.out, HasSubstr("holes (boundary loops)         1  of 4 edges"));
  if (!BODYLOOM_HAS_CGAL) GTEST_SKIP() << "CGAL was not found";
  EXPECT_EQ(result.exit_code, kExitOk) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("mended: 5 faces turned, 1 holes filled\nnothing left\n"));
  const BodyModelData closed = LoadBodyData(Path("closed.npz"));
  const CheckMeshResult mesh = CheckMesh(closed.v_template, closed.faces);
  EXPECT_TRUE(mesh.IsClean());
  EXPECT_EQ(closed.faces.rows(), 12);
  ASSERT_EQ(mesh.components.size(), 1u);
  EXPECT_NEAR(mesh.components[0].volume_m3, 0.008, 1e-6);
}

/// A sheet has a rim, no hole: a second side would lie on the first.
TEST_F(BodyCheck, ASheetGetsNoSecondSide) {
  BodyModelData sheet = Boxes({kCube});
  sheet.faces.conservativeResize(2, 3);
  const CommandResult result = Check(Save("sheet.npz", sheet), {"--repair", Path("out.npz")});
  EXPECT_EQ(result.exit_code, kExitFailed);
  EXPECT_THAT(result.out, HasSubstr("holes (boundary loops)"));
  EXPECT_EQ(LoadBodyData(Path("out.npz")).faces.rows(), 2);
}

TEST_F(BodyCheck, AComponentInsideOutIsTurned) {
  BodyModelData two = Boxes({kCube, Eigen::AlignedBox3d(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1.2, 0.2, 0.2))});
  for (int f = 12; f < 24; ++f) std::swap(two.faces(f, 1), two.faces(f, 2));
  const CommandResult result = Check(Save("two.npz", two), {"--repair", Path("out.npz")});
  EXPECT_THAT(result.out, HasSubstr("faces that face the wrong way  12  the surface is inside out"));
  EXPECT_THAT(result.out, HasSubstr("mended: 12 faces turned\n"));
  EXPECT_THAT(result.out, HasSubstr("left:\n  separate components  2  of 12, 12 faces\n"));
  const BodyModelData out = LoadBodyData(Path("out.npz"));
  EXPECT_TRUE(CheckMesh(out.v_template, out.faces).turned_faces.empty());
}

/// The end of a bar inside a cube, through a side of two triangles: of its four long sides' triangles each crosses the
/// one that it pierces, or both.
TEST_F(BodyCheck, LimbsThatCrossAreCounted) {
  if (!BODYLOOM_HAS_CGAL) GTEST_SKIP() << "CGAL was not found";
  // Triangles of the side x = 0.2 part along y + z = 0.2; the bar's section lies wholly where y + z < 0.2. Each of its
  // eight long triangles meets the plane x = 0.2 between its ends, so each crosses that one triangle.
  const Eigen::AlignedBox3d bar(Eigen::Vector3d(0.1, 0.02, 0.03), Eigen::Vector3d(0.5, 0.06, 0.07));
  const CommandResult result = Check(Save("limbs.npz", Boxes({kCube, bar})));
  EXPECT_EQ(result.exit_code, kExitFailed);
  EXPECT_THAT(result.out, HasSubstr("pairs of faces that cross at rest  8  faces 10x"));
  const Eigen::AlignedBox3d apart(Eigen::Vector3d(0.21, 0.02, 0.03), Eigen::Vector3d(0.5, 0.06, 0.07));
  EXPECT_THAT(Check(Save("apart.npz", Boxes({kCube, apart}))).out, Not(HasSubstr("cross at rest")));
}

/// Faces that are lost at random, or that name other vertices: holes are closed where the rest is a manifold, and the
/// command always ends by itself with a body that has no more holes than before.
TEST_F(BodyCheck, RandomDamageIsMendedOrReported) {
  std::mt19937 random(5);
  int closed = 0;
  for (int round = 0; round < 6; ++round) {
    BodyModelData body = BuiltinBody().data();
    body.ft.resize(0, 3), body.vt.resize(0, 2), body.face_iuv.resize(0, 6), body.face_part.clear();
    for (int i = 0; i < 12; ++i) {
      const auto F = static_cast<int>(body.faces.rows()), V = static_cast<int>(body.v_template.rows());
      const auto f = static_cast<int>(random() % F), k = static_cast<int>(random() % 3);
      if (round % 2 == 1) {
        body.faces(f, k) = static_cast<int>(random() % V);
        continue;
      }
      body.faces.row(f) = body.faces.row(F - 1).eval();
      body.faces.conservativeResize(F - 1, 3);
    }
    const CheckMeshResult before = CheckMesh(body.v_template, body.faces);
    const CommandResult result = Check(Save("damaged.npz", body), {"--repair", Path("out.npz")});
    EXPECT_LE(result.NumErrorLines(), 1) << result.err;
    const BodyModelData out = LoadBodyData(Path("out.npz"));
    const CheckMeshResult after = CheckMesh(out.v_template, out.faces);
    EXPECT_EQ(result.exit_code, after.IsClean() ? kExitOk : kExitFailed) << result.out;
    EXPECT_LE(after.boundary_edges, before.boundary_edges);
    if (!BODYLOOM_HAS_CGAL || !before.non_manifold_edges.empty() || !before.non_manifold_vertices.empty()) continue;
    EXPECT_EQ(after.boundary_edges, 0);
    ++closed;
  }
  EXPECT_GE(closed, BODYLOOM_HAS_CGAL ? 2 : 0);
}

TEST_F(BodyCheck, WrongUse) {
  EXPECT_EQ(RunCommand({"body", "info", "--repair", Path("out.npz")}).exit_code, kExitUsage);
  EXPECT_EQ(Check("", {"--frames", "0:2"}).exit_code, kExitUsage);
  const std::string body = Save("body.npz", BuiltinBody().data());
  EXPECT_EQ(Check(body, {"--repair", body}).exit_code, kExitUsage) << "never over its own input";
  EXPECT_EQ(Check(Path("nowhere.npz")).exit_code, kExitFailed);
}

TEST_F(BodyCheck, FacesThatCross) {
  Track track = ShortTrack();
  track.motion.poses.setZero();
  track.motion.poses(4, 3 * 16 + 2) = -95 * M_PI / 180;  // the left arm is pressed into the trunk
  WriteTrack(Path("track.npz"), track);
  BodyModelData pierced = BuiltinBody().data();
  pierced.v_template(pierced.faces(0, 0), 2) -= 0.3;  // pulled through the back
  const std::string body = Save("pierced.npz", pierced);
  if (!BODYLOOM_HAS_CGAL) {
    EXPECT_THAT(Check(body).out, HasSubstr("crossing faces: not looked for"));
    EXPECT_EQ(Check("", {"--track", Path("track.npz")}).exit_code, kExitUsage);
    return;
  }
  const CommandResult at_rest = Check(body);
  EXPECT_EQ(at_rest.exit_code, kExitFailed);
  EXPECT_THAT(at_rest.out, HasSubstr("pairs of faces that cross at rest"));
  const CommandResult posed = Check("", {"--track", Path("track.npz"), "--frames", "2:6"});
  EXPECT_EQ(posed.exit_code, kExitFailed);
  EXPECT_THAT(posed.out, Not(HasSubstr("at rest  ")));
  EXPECT_THAT(posed.out, HasSubstr("poses in which faces cross  1  of 4; frame 4 has the most pairs"));
  EXPECT_EQ(Check("", {"--track", Path("track.npz"), "--frames", "0:4"}).exit_code, kExitOk);
  // Non-manifold meshes are checked too.
  BodyModelData fin = pierced;
  fin.faces.row(9000) << fin.faces(20, 0), fin.faces(20, 1), 7000;
  const CommandResult torn = Check(Save("fin.npz", fin));
  EXPECT_THAT(torn.out, HasSubstr("edges of more than two faces"));
  EXPECT_THAT(torn.out, HasSubstr("pairs of faces that cross at rest"));
}

}  // namespace
}  // namespace bodyloom::body_check_test
