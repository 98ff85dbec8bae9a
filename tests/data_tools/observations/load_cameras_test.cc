// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/load_cameras.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/datasets/still_camera_files.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/paths.h"

namespace bodyloom::load_cameras_test {
namespace {

using ::testing::HasSubstr;

const char* const kAist =
    R"([{"name":"c01","size":[1920,1080],"matrix":[[1310,0,960],[0,1312,540],[0,0,1]],"distortions":[-0.1,0.01,0,0,0],)"
    R"("rotation":[3.1,0,0],"translation":[-3,180,450]},)"
    R"({"name":"c02","size":[640,480],"matrix":[[500,0,320],[0,500,240],[0,0,1]],"distortions":[],)"
    R"("rotation":[[1,0,0],[0,1,0],[0,0,1]],"translation":[0,0,100]}])";

class LoadCamerasTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& bytes) {
    WriteFileAtomically(folder_.File(name), bytes);
    return folder_.File(name);
  }
  std::string ErrorOf(const std::string& text) {
    const std::string path = Write("bad.json", text);
    return FileErrorOf(path, [&] { LoadCameras(path); });
  }
  TemporaryFolder folder_;
};

TEST_F(LoadCamerasTest, AistFileAndFolder) {
  Write("setting1.json", kAist);
  Write("mapping.txt", "gX_sBM_cAll_d01_mX0_ch01 setting9\ngBR_sBM_cAll_d06_mBR2_ch06 setting1\n");
  for (const char* sequence :
       {"gBR_sBM_cAll_d06_mBR2_ch06", "gBR_sBM_c03_d06_mBR2_ch06.mp4", "/videos/gBR_sBM_cAll_d06_mBR2_ch06.pkl"}) {
    const std::vector<NamedCamera> cameras = LoadCameras(folder_.File(""), sequence);
    ASSERT_EQ(cameras.size(), 2U);
    const NamedCamera& c01 = FindCamera(cameras, "c01", "x");
    EXPECT_EQ(c01.camera.width, 1920);
    EXPECT_EQ(c01.camera.fy, 1312);
    EXPECT_EQ(c01.camera.cx, 960);
    EXPECT_EQ(c01.camera.distortion[1], 0.01);
    EXPECT_NEAR(c01.pose.camera_from_world_translation.z(), 4.5, 1e-12) << "centimetres";
    EXPECT_NEAR(RotationAngleBetween(c01.pose.camera_from_world_rotation, Eigen::Matrix3d::Identity()), 3.1, 1e-12);
  }
  EXPECT_EQ(LoadCameras(folder_.File("setting1.json")).size(), 2U);
  const auto error = [&](const std::string& sequence) {
    return FileErrorOf("mapping.txt", [&] { LoadCameras(folder_.File(""), sequence); });
  };
  EXPECT_THAT(error(""), HasSubstr("needs the name of the sequence"));
  EXPECT_THAT(error("gXX"), HasSubstr("no sequence 'gXX'"));
  FileErrorOf("setting9.json", [&] { LoadCameras(folder_.File(""), "gX_sBM_cAll_d01_mX0_ch01"); });
  Write("mapping.txt", "a ../../etc/passwd\n");
  EXPECT_THAT(error("a"), HasSubstr("plain name"));
  const std::vector<NamedCamera> cameras = LoadCameras(folder_.File("setting1.json"));
  EXPECT_THAT(FileErrorOf("s.json", [&] { FindCamera(cameras, "c09", "s.json"); }),
              HasSubstr("no camera 'c09'; the file has c01, c02"));
  EXPECT_THAT(FileErrorOf("s.json", [&] { FindCamera(cameras, "", "s.json"); }), HasSubstr("no view chosen"));
}

TEST_F(LoadCamerasTest, Pose2SimWithAffine) {
  const std::string path =
      Write("calib_refined.json",
            R"({"note":"x","cameras":[{"name":"cam_01","size":[1088,1920],"K":[[1681,0,533],[0,1682,948],[0,0,1]],)"
            R"("dist_k1k2p1p2":[-0.05,0.1,0.001,0.002],"rvec":[0,0,0],"tvec_m":[0.3,0.9,2.9]}]})");
  EXPECT_EQ(LoadCameras(path)[0].video_px_from_camera_px(0, 0), 1);
  Write("video_to_calib_affine.json", R"({"cam01":{"video_to_calib_affine":[[2,0,4],[0,2,-6]]},"cam09":{}})");
  for (const std::string& place : {path, folder_.File("")}) {
    const std::vector<NamedCamera> cameras = LoadCameras(place);
    const NamedCamera& camera = FindCamera(cameras, "cam01", "x");
    EXPECT_EQ(camera.name, "cam_01");
    EXPECT_EQ(camera.camera.distortion[3], 0.002);
    EXPECT_EQ(camera.pose.camera_from_world_translation.y(), 0.9);
    const Eigen::Vector2d video_px = camera.video_px_from_camera_px * Eigen::Vector3d(10, 20, 1);
    EXPECT_NEAR(video_px.x(), 3, 1e-12);
    EXPECT_NEAR(video_px.y(), 13, 1e-12);
  }
}

TEST_F(LoadCamerasTest, Pose2SimToml) {
  const std::string good =
      "# two cameras\n[int_cam01_img]\nname = \"cam_01\"\nsize = [ 1088.0, 1920.0]\n"
      "matrix = [ [ 1681.0, 0.0, 533.0],\n [ 0.0, 1682.0, 948.0], [ 0.0, 0.0, 1.0]]  # px\n"
      "distortions = [ -0.05, 0.1, 0.001, 0.002]\nrotation = [ 0.1, 0.2, 0.3]\ntranslation = [ 0.3, 0.9, 2.9]\n"
      "fisheye = false\n\n[cameras.second]\nsize = [ 640, 480]\nmatrix = [[500,0,320],[0,500,240],[0,0,1]]\n"
      "[metadata]\nadjusted = false\nname = 5\n";
  const std::vector<NamedCamera> cameras = LoadCameras(Write("Calib.toml", good));
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[0].name, "cam_01");
  EXPECT_EQ(cameras[0].camera.width, 1088);
  EXPECT_EQ(cameras[0].camera.fy, 1682);
  EXPECT_EQ(cameras[0].camera.distortion[3], 0.002);
  EXPECT_EQ(cameras[0].pose.camera_from_world_translation.z(), 2.9);
  EXPECT_TRUE(cameras[0].pose.camera_from_world_rotation.isApprox(RotationFromAxisAngle({0.1, 0.2, 0.3}), 1e-12));
  EXPECT_EQ(cameras[1].name, "second");
  const auto error = [&](const std::string& text) {
    const std::string path = Write("bad.toml", text);
    return FileErrorOf(path, [&] { LoadCameras(path); });
  };
  EXPECT_THAT(error("[metadata]\nerror = 0.0\n"), HasSubstr("no camera"));
  EXPECT_THAT(error("[a]\nsize = [ 640]\n"), HasSubstr("line 2: 'size = [ 640]', expected size = [width, height]"));
  EXPECT_THAT(error("[a]\nmatrix = [ [ 1, 2\n"), HasSubstr("line 2: 'matrix = [ [ 1, 2', expected TOML: "));
  EXPECT_THAT(error("[a]\nmatrix\n"), HasSubstr("line 2: 'matrix', expected TOML: "));
  EXPECT_THAT(error("[a\n"), HasSubstr("line 1: '[a', expected TOML: "));
  EXPECT_THAT(error("[a]\nsize = [ 640, 480]\nsize = [ 1, 2]\n"),
              HasSubstr("line 3: 'size = [ 1, 2]', expected TOML: "));
  EXPECT_THAT(error("[a]\nsize = [ 640, 480]\n"), HasSubstr("no 'fx'"));
  EXPECT_THAT(error("[a]\nsize = [ 640, 1979-05-27]\n"), HasSubstr("height"));
  EXPECT_THAT(error("[a]\nname = 5\nsize = [ 640, 480]\n"), HasSubstr("name"));
  EXPECT_THAT(error("[a]\nsize = [ 640, 480]\nmatrix = [[inf,0,320],[0,500,240],[0,0,1]]\n"), HasSubstr("finite"));
  std::string deep = "a";
  for (int i = 0; i < 200000; ++i) deep += ".a";
  EXPECT_THAT(error("[a]\n[" + deep + "]\n"), HasSubstr("line 2: '[a.a."));
  EXPECT_THAT(error("a = " + std::string(200000, '[')), HasSubstr("line 1: 'a = [["));
  // Of TOML, what calibrations seldom hold.
  const std::string odd =
      "when = 1979-05-27T07:32:00Z\n[z]\nnote = \"a # in [ a text\"\nfolder = { a = 1, b = [ 2 ] }\n"
      "size = [ 640, 480 ]\nmatrix = [ [ 5e2, 0, 320 ], [ 0, 500, 240 ], [ 0, 0, 1 ], ]\n"
      "[a]\nsize = [ 32, 24 ]\nmatrix = [[50,0,16],[0,50,12],[0,0,1]]\n";
  const std::vector<NamedCamera> ordered = LoadCameras(Write("odd.toml", odd));
  ASSERT_EQ(ordered.size(), 2U);
  EXPECT_EQ(ordered[0].name, "z") << "in the order of the file";
  EXPECT_EQ(ordered[0].camera.fx, 500);
  EXPECT_EQ(ordered[1].camera.width, 32);
  for (size_t n = 0; n < good.size(); n += 7) {
    try {
      LoadCameras(Write("cut.toml", good.substr(0, n)));
    } catch (const std::runtime_error&) {
    }
  }
}

TEST_F(LoadCamerasTest, Human36mWithCentreOrTranslation) {
  const NamedCamera expected = RoomCamera();
  for (const bool is_centre : {true, false}) {
    const std::vector<NamedCamera> cameras = LoadCameras(Write("c.json", Human36mCameraJson(expected, is_centre)));
    ASSERT_EQ(cameras.size(), 1U);
    EXPECT_EQ(cameras[0].name, "1");
    EXPECT_EQ(cameras[0].camera.height, 1002);
    EXPECT_TRUE(cameras[0].has_pose);
    EXPECT_TRUE(cameras[0].camera.K().isApprox(expected.camera.K(), 1e-12));
    EXPECT_TRUE(cameras[0].pose.camera_from_world_rotation.isApprox(expected.pose.camera_from_world_rotation, 1e-9));
    EXPECT_TRUE(
        cameras[0].pose.camera_from_world_translation.isApprox(expected.pose.camera_from_world_translation, 1e-9));
  }
  NamedCamera away = expected;
  away.pose.camera_from_world_translation.x() += 50;
  EXPECT_THAT(ErrorOf(Human36mCameraJson(away, false)), HasSubstr("expected a camera that shows the origin"));
  EXPECT_THAT(ErrorOf(R"({"1": {"R": [1], "f": [1, 1]}})"), HasSubstr("1: no 'c'"));
}

TEST_F(LoadCamerasTest, OwnFormRoundTrip) {
  NamedCamera a, b;
  a.name = "left";
  a.camera = MakePinhole(640, 480, 500);
  a.camera.fy = 510;
  a.camera.distortion[0] = -0.2;
  a.camera.distortion[7] = 0.001;
  a.pose.camera_from_world_rotation = RotationFromAxisAngle({0.3, -0.2, 0.9});
  a.pose.camera_from_world_translation = {0.1, 0.2, 3};
  b.name = "weak";
  b.camera.model = CameraModel::kWeakPerspective;
  b.camera.width = 512;
  b.camera.height = 256;
  b.camera.scale = 300;
  b.camera.tx = 0.5;
  WriteCameras(folder_.File("cams.json"), {a, b});
  const std::vector<NamedCamera> cameras = LoadCameras(folder_.File("cams.json"));
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[0].camera.fy, 510);
  EXPECT_EQ(cameras[0].camera.distortion, a.camera.distortion);
  EXPECT_TRUE(cameras[0].pose.camera_from_world_rotation.isApprox(a.pose.camera_from_world_rotation, 1e-14));
  EXPECT_EQ(cameras[0].pose.camera_from_world_translation, a.pose.camera_from_world_translation);
  EXPECT_EQ(cameras[1].camera.model, CameraModel::kWeakPerspective);
  EXPECT_EQ(cameras[1].camera.scale, 300);
  EXPECT_EQ(cameras[1].camera.tx, 0.5);

  const NamedCamera one = LoadCameras(Write("one.json", R"({"width":640,"height":480,"fx":600})"))[0];
  EXPECT_EQ(one.camera.fy, 600);
  EXPECT_EQ(one.camera.cx, 319.5);
  const NamedCamera matrix =
      LoadCameras(Write("k.json", R"({"width":640,"height":480,"K":[[600,0,320],[0,601,240],[0,0,1]]})"))[0];
  EXPECT_EQ(matrix.camera.fy, 601);
}

TEST_F(LoadCamerasTest, MalformedFilesAreErrors) {
  EXPECT_THAT(ErrorOf("{}"), HasSubstr("no 'width'"));
  EXPECT_THAT(ErrorOf("[]"), HasSubstr("expected a list of cameras"));
  EXPECT_THAT(ErrorOf("5"), HasSubstr("expected a list of cameras"));
  EXPECT_THAT(ErrorOf("[5]"), HasSubstr("expected a camera"));
  EXPECT_THAT(ErrorOf(R"({"width":640,"height":480})"), HasSubstr("no 'fx'"));
  EXPECT_THAT(ErrorOf(R"({"width":640,"height":480,"fx":-5})"), HasSubstr("focal length"));
  EXPECT_THAT(ErrorOf(R"({"width":0,"height":480,"fx":5})"), HasSubstr("image size"));
  EXPECT_THAT(ErrorOf(R"({"width":64.5,"height":480,"fx":5})"), HasSubstr("image size"));
  EXPECT_THAT(ErrorOf(R"({"width":640,"height":480,"fx":500,"cx":99999})"), HasSubstr("principal point"));
  EXPECT_THAT(ErrorOf(R"({"width":640,"height":480,"model":"fisheye"})"), HasSubstr("'fisheye'"));
  EXPECT_THAT(ErrorOf(R"({"width":640,"height":480,"model":"weak","scale":0})"), HasSubstr("scale"));
  EXPECT_THAT(ErrorOf(R"({"width":640,"height":480,"K":[[600,5,320],[0,601,240],[0,0,1]]})"), HasSubstr("skew"));
  EXPECT_THAT(ErrorOf(R"({"width":640,"height":480,"K":[600,0,320]})"), HasSubstr("3 numbers, expected 9"));
  EXPECT_THAT(ErrorOf(R"({"width":640,"height":480,"fx":5,"distortion":[1,2,3,4,5,6,7,8,9]})"), HasSubstr("at most 8"));
  EXPECT_THAT(ErrorOf(R"({"width":6,"height":4,"fx":5,"rotation":[1,0],"translation":[0,0,0]})"),
              HasSubstr("2 numbers"));
  EXPECT_THAT(ErrorOf(R"({"width":6,"height":4,"fx":5,"rotation":[[1,0,0],[0,1,0],[0,0,-1]],"translation":[0,0,0]})"),
              HasSubstr("not a rotation"));
  EXPECT_THAT(ErrorOf(R"({"width":6,"height":4,"fx":NaN})"), HasSubstr("NaN"));
  const std::string text = kAist;
  for (size_t n = 0; n < text.size(); n += 3) ErrorOf(text.substr(0, n));
  std::filesystem::create_directory(folder_.File("empty"));
  EXPECT_THAT(FileErrorOf("empty", [&] { LoadCameras(folder_.File("empty")); }), HasSubstr("mapping.txt"));
}

TEST(RealCameras, EverySettingLoads) {
  const std::string data = SharedDir() + "/data";
  if (!std::filesystem::exists(data + "/aistpp")) GTEST_SKIP() << "no recordings in " << data;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data + "/aistpp/cameras")) {
    if (entry.path().extension() != ".json") continue;
    EXPECT_EQ(LoadCameras(entry.path().string()).size(), 9U);
    ++count;
  }
  EXPECT_GT(count, 5);
  const std::vector<NamedCamera> cameras = LoadCameras(data + "/aistpp/cameras", "gBR_sBM_cAll_d06_mBR2_ch06");
  EXPECT_NEAR(FindCamera(cameras, "c01", "x").camera.fx, 1310.486, 1e-3);
  EXPECT_EQ(LoadCameras(data + "/pose2sim").size(), 4U);
}

}  // namespace
}  // namespace bodyloom::load_cameras_test
