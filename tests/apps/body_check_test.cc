// SPDX-License-Identifier: Apache-2.0
// `bodyloom body info --check` as a user meets it, on damaged copies of the built-in body.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

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

TEST_F(BodyCheck, AHoleStays) {
  const CommandResult result = Check(Save("hole.npz", WithoutItsLastFace()), {"--repair", Path("out.npz")});
  EXPECT_EQ(result.exit_code, kExitFailed);
  EXPECT_THAT(result.out, HasSubstr("mended: nothing\nleft:\n  holes (boundary loops)  1  of 3 edges"));
  EXPECT_TRUE(std::filesystem::exists(Path("out.npz")));
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
  // What no half-edge structure holds is looked at too.
  BodyModelData fin = pierced;
  fin.faces.row(9000) << fin.faces(20, 0), fin.faces(20, 1), 7000;
  const CommandResult torn = Check(Save("fin.npz", fin));
  EXPECT_THAT(torn.out, HasSubstr("edges of more than two faces"));
  EXPECT_THAT(torn.out, HasSubstr("pairs of faces that cross at rest"));
}

}  // namespace
}  // namespace bodyloom::body_check_test
