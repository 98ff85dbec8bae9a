// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/rig_io.h"

#include <gmock/gmock.h>

#include <cmath>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::rig_io_test {
namespace {

using ::testing::HasSubstr;

std::vector<RigCamera> TwoCameras() {
  std::vector<RigCamera> rig(2);
  rig[0].name = "left";
  rig[0].camera = MakePinhole(1920, 1080, 1500);
  rig[0].focal_log_sigma = 0.03;
  rig[1].name = "right";
  rig[1].camera = MakePinhole(1280, 720, 1010);
  rig[1].camera.distortion[0] = -0.1;
  rig[1].camera_from_rig.camera_from_world_rotation = RotationFromAxisAngle({0.1, -0.9, 0.05});
  rig[1].camera_from_rig.camera_from_world_translation = {2.5, -0.1, 1.25};
  rig[1].offset_s = -1.75;
  rig[1].rate = 3e-5;
  rig[1].middle_s = 4.5;
  rig[1].rotation_sigma_rad = 0.008;
  rig[1].translation_sigma_m = 0.06;
  rig[1].offset_sigma_s = 0.004;
  rig[1].rate_sigma = std::nan("");
  return rig;
}

TEST(RigFile, HoldsCamerasClocksAndStandardDeviations) {
  const TemporaryFolder folder;
  const std::vector<RigCamera> rig = TwoCameras();
  WriteRig(folder.File("rig.json"), rig);
  const std::vector<RigCamera> read = ReadRig(folder.File("rig.json"));
  ASSERT_EQ(read.size(), 2U);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].name, rig[i].name);
    EXPECT_EQ(read[i].camera.width, rig[i].camera.width);
    EXPECT_EQ(read[i].camera.fx, rig[i].camera.fx);
    EXPECT_EQ(read[i].camera.cx, rig[i].camera.cx);
    EXPECT_EQ(read[i].camera.distortion, rig[i].camera.distortion);
    EXPECT_LT(
        (read[i].camera_from_rig.camera_from_world_rotation - rig[i].camera_from_rig.camera_from_world_rotation).norm(),
        1e-14);
    EXPECT_EQ(read[i].camera_from_rig.camera_from_world_translation,
              rig[i].camera_from_rig.camera_from_world_translation);
    EXPECT_EQ(read[i].offset_s, rig[i].offset_s);
    EXPECT_EQ(read[i].rate, rig[i].rate);
    EXPECT_EQ(read[i].middle_s, rig[i].middle_s);
    EXPECT_EQ(read[i].rotation_sigma_rad, rig[i].rotation_sigma_rad);
    EXPECT_EQ(read[i].translation_sigma_m, rig[i].translation_sigma_m);
    EXPECT_EQ(read[i].focal_log_sigma, rig[i].focal_log_sigma);
    EXPECT_EQ(read[i].offset_sigma_s, rig[i].offset_sigma_s);
  }
  EXPECT_EQ(read[0].rate_sigma, 0) << "given";
  EXPECT_TRUE(std::isnan(read[1].rate_sigma)) << "not known";
}

TEST(RigFile, IsAFileOfCameras) {
  const TemporaryFolder folder;
  WriteRig(folder.File("rig.json"), TwoCameras());
  const std::vector<NamedCamera> cameras = LoadCameras(folder.File("rig.json"));
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(FindCamera(cameras, "right", "x").camera.fx, 1010);
  EXPECT_TRUE(cameras[1].has_pose);
  EXPECT_EQ(cameras[1].pose.camera_from_world_translation.x(), 2.5);
  EXPECT_TRUE(IsRigFile(folder.File("rig.json")));
  WriteCameras(folder.File("cameras.json"), cameras);
  EXPECT_FALSE(IsRigFile(folder.File("cameras.json")));
  EXPECT_FALSE(IsRigFile(folder.File("")));
  WriteFileAtomically(folder.File("one.json"), R"({"width":640,"height":480,"fx":600})");
  EXPECT_FALSE(LoadCameras(folder.File("one.json"))[0].has_pose);
}

std::string ErrorOfRig(const std::string& text) {
  return FileErrorOf("bad.json", [&] { RigFromText(text, "bad.json"); });
}

/// A rig of one camera with these further keys.
std::string RigWith(const std::string& keys) {
  return R"({"rig":1,"cameras":[{"name":"a","width":640,"height":480,"fx":600)" + keys + "}]}";
}

TEST(RigFile, MissingClocksAreNotKnown) {
  const std::vector<RigCamera> rig = RigFromText(RigWith(R"(,"rotation":[0,0,0],"translation":[0,0,0])"), "a.json");
  EXPECT_FALSE(rig[0].HasClock());
  EXPECT_EQ(rig[0].rate, 0);
  EXPECT_TRUE(std::isnan(rig[0].offset_sigma_s));
}

TEST(RigFile, MalformedFilesAreErrors) {
  const std::string pose = R"(,"rotation":[0,0,0],"translation":[0,0,0])";
  EXPECT_THAT(ErrorOfRig("{}"), HasSubstr("the key 'rig'"));
  EXPECT_THAT(ErrorOfRig("[]"), HasSubstr("the key 'rig'"));
  EXPECT_THAT(ErrorOfRig(R"({"rig":2,"cameras":[]})"), HasSubstr("the version of the form"));
  EXPECT_THAT(ErrorOfRig(R"({"rig":1,"cameras":[]})"), HasSubstr("a list of cameras"));
  EXPECT_THAT(ErrorOfRig(R"({"rig":1,"width":640,"height":480,"fx":600,"rotation":[0,0,0],"translation":[0,0,0]})"),
              HasSubstr("cameras"));
  EXPECT_THAT(ErrorOfRig(RigWith("")), HasSubstr("a camera with a pose"));
  EXPECT_THAT(ErrorOfRig(RigWith(pose + R"(,"offset_s":"x")")), HasSubstr("offset_s"));
  EXPECT_THAT(ErrorOfRig(RigWith(pose + R"(,"rate":-1)")), HasSubstr("clocks run forwards"));
  EXPECT_THAT(ErrorOfRig(RigWith(pose + R"(,"focal_log_sigma":-0.1)")), HasSubstr("0 or more"));
  EXPECT_THAT(ErrorOfRig(R"({"rig":1,"cameras":[{"model":"weak","width":6,"height":4,"scale":5,)"
                         R"("rotation":[0,0,0],"translation":[0,0,0]}]})"),
              HasSubstr("a pinhole camera"));
  const TemporaryFolder folder;
  WriteRig(folder.File("rig.json"), TwoCameras());
  const std::string text = ReadFileBytes(folder.File("rig.json"));
  for (size_t n = 0; n + 3 < text.size(); n += 5) ErrorOfRig(text.substr(0, n));
  EXPECT_THROW(WriteRig(folder.File("none.json"), {}), std::invalid_argument);
  std::vector<RigCamera> weak = TwoCameras();
  weak[1].camera.model = CameraModel::kWeakPerspective;
  EXPECT_THROW(WriteRig(folder.File("weak.json"), weak), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::rig_io_test
