// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/load_camera_path.h"

#include <gmock/gmock.h>

#include "data_tools/formats/atomic_file.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::load_camera_path_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<double> kClip = {0, 0.1, 0.2, 0.3};

std::string ImageLines(const std::string& name, double x) {
  return "1 1 0 0 0 " + std::to_string(x) + " 0 0 1 " + name + "\n\n";
}

class CameraPathFile : public ::testing::Test {
 protected:
  RecordedCameraPath Colmap(const std::string& images, const std::string& cameras = "") {
    WriteFileAtomically(folder_.File("images.txt"), images);
    if (!cameras.empty()) WriteFileAtomically(folder_.File("cameras.txt"), cameras);
    return LoadCameraPath(folder_.File(""));
  }
  static std::string ErrorOf(const std::string& text) {
    return FileErrorOf("path.json", [&] { CameraPathFromText(text, "path.json"); });
  }
  TemporaryFolder folder_;
};

TEST_F(CameraPathFile, RoundTrip) {
  const CameraPath path{{0, 0.25, 1},
                        {{RotationFromAxisAngle({0.1, 0.2, 3}), {1, 2, 3}},
                         {RotationFromAxisAngle({-1, 0.2, 0.3}), {1, -2, 3}},
                         {RotationFromAxisAngle({0, 0, 0}), {0, 0, 0}}}};
  WriteCameraPath(folder_.File("path.json"), path);
  const RecordedCameraPath read = LoadCameraPath(folder_.File("path.json"));
  EXPECT_TRUE(read.is_metric);
  EXPECT_EQ(read.seconds, path.timestamps);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(read.poses[i].camera_from_world_rotation.isApprox(path.poses[i].camera_from_world_rotation, 1e-12));
    EXPECT_EQ(read.poses[i].camera_from_world_translation, path.poses[i].camera_from_world_translation);
  }
  EXPECT_EQ(CameraPathOnClock(read, kClip, {}, "x").timestamps, path.timestamps);
  WriteCameraPath(folder_.File("units.json"), path, false);
  EXPECT_FALSE(LoadCameraPath(folder_.File("units.json")).is_metric);
}

TEST_F(CameraPathFile, FramesQuaternionsAndIntrinsics) {
  const RecordedCameraPath read =
      CameraPathFromText(R"({"camera_path":1,"camera":{"width":640,"height":480,"fx":500},"frames":[)"
                         R"({"frame":0,"quaternion":[1,0,0,0],"translation":[0,0,0]},)"
                         R"({"frame":3,"quaternion":[0.7071068,0,0,0.7071068],"translation":[1,0,0]}]})",
                         "path.json");
  ASSERT_TRUE(read.camera);
  EXPECT_EQ(read.camera->fx, 500);
  EXPECT_NEAR(read.poses[1].camera_from_world_rotation(1, 0), 1, 1e-7);
  EXPECT_THAT(CameraPathOnClock(read, kClip, {}, "x").timestamps, ElementsAre(0, 0.3));
  EXPECT_THAT(CameraPathOnClock(read, kClip, {.fps = 5}, "x").timestamps, ElementsAre(0, 0.6));
}

TEST_F(CameraPathFile, UnitsAreMetresUnlessItSaysOtherwise) {
  const std::string frames = R"("frames":[{"frame":1,"quaternion":[1,0,0,0],"translation":[1,0,0]}]})";
  EXPECT_TRUE(CameraPathFromText(R"({"camera_path":1,"metric":true,)" + frames, "x").is_metric);
  const RecordedCameraPath units = CameraPathFromText(R"({"camera_path":1,"metric":false,)" + frames, "x");
  EXPECT_FALSE(units.is_metric);
  EXPECT_THAT(CameraPathOnClock(units, kClip, {}, "x").timestamps, ElementsAre(0.1))
      << "counted from 0, as no COLMAP's";
  EXPECT_THAT(ErrorOf(R"({"camera_path":1,"metric":"no",)" + frames), HasSubstr("metric"));
}

TEST_F(CameraPathFile, ColmapsImagesAreFramesByTheirNumbers) {
  const RecordedCameraPath read =
      Colmap(ImageLines("v2/f_0010.png", 10) + ImageLines("v2/f_0002.png", 2) + ImageLines("v2/f_0001.png", 1),
             "1 SIMPLE_PINHOLE 640 480 500 320 240\n");
  EXPECT_FALSE(read.is_metric);
  EXPECT_THAT(read.frames, ElementsAre(1, 2, 10));
  EXPECT_EQ(read.poses[2].camera_from_world_translation.x(), 10);
  EXPECT_EQ(read.camera->cx, 319.5);
  // Counted from one, because none is 0; frame 10 is beyond the clip.
  EXPECT_THAT(CameraPathOnClock(read, kClip, {}, "x").timestamps, ElementsAre(0, 0.1));
  EXPECT_THAT(CameraPathOnClock(read, kClip, {.first = 0}, "x").timestamps, ElementsAre(0.1, 0.2));
  EXPECT_THAT(CameraPathOnClock(read, kClip, {.first = 1, .fps = 10}, "x").timestamps, ElementsAre(0, 0.1, 0.9));
  EXPECT_THAT(FileErrorOf("x", [&] { CameraPathOnClock(read, kClip, {.first = 50}, "x"); }),
              HasSubstr("none is in the clip of 4 frames"));
  EXPECT_THAT(Colmap(ImageLines("f0.png", 0) + ImageLines("f1.png", 1)).frames, ElementsAre(0, 1));
}

TEST_F(CameraPathFile, ImagesWithoutNumbersAreCountedByName) {
  const RecordedCameraPath read = Colmap(ImageLines("b.png", 2) + ImageLines("a.png", 1));
  EXPECT_TRUE(read.by_sorted_name);
  EXPECT_EQ(read.poses[0].camera_from_world_translation.x(), 1);
  EXPECT_THAT(CameraPathOnClock(read, kClip, {}, "x").timestamps, ElementsAre(0, 0.1));
  EXPECT_FALSE(read.camera);
  EXPECT_THAT(read.why_no_camera, HasSubstr("no cameras file"));
}

TEST_F(CameraPathFile, RefusesWhatIsNoPath) {
  EXPECT_THAT(ErrorOf("[]"), HasSubstr("camera_path"));
  EXPECT_THAT(ErrorOf(R"({"camera_path":2,"frames":[]})"), HasSubstr("expected version 1"));
  EXPECT_THAT(ErrorOf(R"({"camera_path":1,"frames":[]})"), HasSubstr("a list of frames"));
  const auto frames = [&](const std::string& list) { return ErrorOf(R"({"camera_path":1,"frames":[)" + list + "]}"); };
  const std::string pose = R"("rotation":[0,0,0],"translation":[0,0,0]})";
  EXPECT_THAT(frames(R"({"frame":1,)" + pose + R"(,{"frame":1,)" + pose), HasSubstr("rising frame numbers"));
  EXPECT_THAT(frames(R"({"time":1,)" + pose + R"(,{"time":0.5,)" + pose), HasSubstr("rising times"));
  EXPECT_THAT(frames(R"({"time":1,)" + pose + R"(,{"frame":2,)" + pose), HasSubstr("time"));
  EXPECT_THAT(frames(R"({"frame":-1,)" + pose), HasSubstr("rising frame numbers"));
  EXPECT_THAT(frames(R"({"frame":0,"quaternion":[2,0,0,0],"translation":[0,0,0]})"), HasSubstr("unit quaternion"));
  EXPECT_THAT(frames(R"({"frame":0,"rotation":[1,0,0,0,1,0,0,0,-1],"translation":[0,0,0]})"),
              HasSubstr("not a rotation"));
  EXPECT_THAT(frames(R"({"frame":0,"rotation":[0,0,0],"translation":[0,0]})"), HasSubstr("translation"));
  EXPECT_THAT(ErrorOf(R"({"camera_path":1,"fps":0,"frames":[{"frame":0,)" + pose + "]}"), HasSubstr("fps"));
  EXPECT_THAT(FileErrorOf(folder_.File(""), [&] { LoadCameraPath(folder_.File("")); }), HasSubstr("images.bin"));
}

}  // namespace
}  // namespace bodyloom::load_camera_path_test
