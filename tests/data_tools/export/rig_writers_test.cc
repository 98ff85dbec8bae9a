// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/camera_writers.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/colmap_reader.h"
#include "geometry/math/rotation.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::rig_writers_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<NamedCamera> TwoCameras() {
  std::vector<NamedCamera> cameras(2);
  cameras[0].name = "c01";
  cameras[0].camera = MakePinhole(1920, 1080, 1500);
  cameras[1].name = "c02";
  cameras[1].camera = MakePinhole(1280, 720, 1010.125);
  cameras[1].camera.distortion = {-0.1, 0.02, 0.003, -0.004};
  cameras[1].pose.camera_from_world_rotation = RotationFromAxisAngle({0.1, -0.9, 0.05});
  cameras[1].pose.camera_from_world_translation = {2.5, -0.1, 1.25};
  return cameras;
}

void ExpectSameCamera(const NamedCamera& read, const NamedCamera& written) {
  EXPECT_EQ(read.camera.width, written.camera.width);
  EXPECT_EQ(read.camera.height, written.camera.height);
  EXPECT_NEAR(read.camera.fx, written.camera.fx, 1e-9);
  EXPECT_NEAR(read.camera.fy, written.camera.fy, 1e-9);
  EXPECT_NEAR(read.camera.cx, written.camera.cx, 1e-9);
  EXPECT_NEAR(read.camera.cy, written.camera.cy, 1e-9);
  for (size_t i = 0; i < 8; ++i) EXPECT_NEAR(read.camera.distortion[i], written.camera.distortion[i], 1e-12);
  EXPECT_LT((read.pose.camera_from_world_rotation - written.pose.camera_from_world_rotation).norm(), 1e-12);
  EXPECT_LT((read.pose.camera_from_world_translation - written.pose.camera_from_world_translation).norm(), 1e-12);
}

TEST(RigWriters, Pose2SimComesBack) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.File("Calib.toml"), Pose2SimRigText(TwoCameras()));
  const std::vector<NamedCamera> read = LoadCameras(folder.File("Calib.toml"));
  ASSERT_EQ(read.size(), 2U);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].name, TwoCameras()[i].name);
    ExpectSameCamera(read[i], TwoCameras()[i]);
  }
  std::vector<NamedCamera> cameras = TwoCameras();
  cameras[1].camera.distortion[4] = 0.1;
  EXPECT_THAT([&] { Pose2SimRigText(cameras); }, ThrowsMessage<std::invalid_argument>(HasSubstr("beyond k1 k2 p1 p2")));
}

NamedCamera CameraOfOpenCv(const cv::FileNode& node) {
  NamedCamera named;
  node["name"] >> named.name;
  node["image_width"] >> named.camera.width;
  node["image_height"] >> named.camera.height;
  cv::Mat K, distortion, R, t;
  node["camera_matrix"] >> K;
  node["distortion_coefficients"] >> distortion;
  node["rotation"] >> R;
  node["translation"] >> t;
  named.camera.fx = K.at<double>(0, 0);
  named.camera.fy = K.at<double>(1, 1);
  named.camera.cx = K.at<double>(0, 2);
  named.camera.cy = K.at<double>(1, 2);
  for (int i = 0; i < distortion.cols; ++i) named.camera.distortion[size_t(i)] = distortion.at<double>(0, i);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) named.pose.camera_from_world_rotation(r, c) = R.at<double>(r, c);
    named.pose.camera_from_world_translation[r] = t.at<double>(r, 0);
  }
  return named;
}

TEST(RigWriters, OpenCvReadsItsYaml) {
  std::vector<NamedCamera> cameras = TwoCameras();
  cameras[0].name = "a camera: \"left\"";
  for (const double k6 : {0.0, 0.5}) {
    cameras[1].camera.distortion[7] = k6;
    const TemporaryFolder folder;
    WriteFileAtomically(folder.File("rig.yml"), OpenCvRigText(cameras));
    const cv::FileStorage storage(folder.File("rig.yml"), cv::FileStorage::READ);
    const cv::FileNode list = storage["cameras"];
    ASSERT_EQ(list.size(), 2U);
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(CameraOfOpenCv(list[i]).name, cameras[size_t(i)].name);
      ExpectSameCamera(CameraOfOpenCv(list[i]), cameras[size_t(i)]);
    }
    cv::Mat distortion;
    list[1]["distortion_coefficients"] >> distortion;
    EXPECT_EQ(distortion.cols, k6 == 0 ? 5 : 8);
  }
}

TEST(RigWriters, ColmapComesBack) {
  const TemporaryFolder folder;
  WriteColmapRig(folder.File(""), TwoCameras());
  const ColmapModel model = ReadColmapModel(folder.File(""));
  ASSERT_EQ(model.images.size(), 2U);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(model.images[i].name, TwoCameras()[i].name + ".png");
    NamedCamera read;
    read.camera = model.cameras.at(model.images[i].camera_id).camera;
    read.pose = model.images[i].pose;
    ExpectSameCamera(read, TwoCameras()[i]);
  }
  EXPECT_EQ(model.cameras.at(1).model, "PINHOLE");
  EXPECT_EQ(model.cameras.at(2).model, "FULL_OPENCV");
  EXPECT_THAT(ReadFileBytes(folder.File("points3D.txt")), HasSubstr("# POINT3D_ID"));
}

TEST(RigWriters, CamerasThatHaveNoPlaceAreErrors) {
  std::vector<NamedCamera> cameras = TwoCameras();
  cameras[1].name = "c01";
  EXPECT_THAT([&] { OpenCvRigText(cameras); }, ThrowsMessage<std::invalid_argument>(HasSubstr("called 'c01'")));
  cameras[1].name = "";
  EXPECT_THROW(OpenCvRigText(cameras), std::invalid_argument);
  cameras[1].name = "b c";
  EXPECT_THROW(Pose2SimRigText(cameras), std::invalid_argument);
  cameras[1].camera.model = CameraModel::kWeakPerspective;
  EXPECT_THROW(OpenCvRigText(cameras), std::invalid_argument);
  EXPECT_THROW(OpenCvRigText({}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::rig_writers_test
