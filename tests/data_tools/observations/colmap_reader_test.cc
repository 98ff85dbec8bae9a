// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/colmap_reader.h"

#include <gmock/gmock.h>

#include <cstring>

#include "data_tools/formats/atomic_file.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::colmap_reader_test {
namespace {

using ::testing::HasSubstr;

const char* const kCamerasText =
    "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS\n"
    "1 PINHOLE 640 480 600 610 320 240\n"
    "2 OPENCV 1920 1080 1500 1510 960 540 0.1 -0.2 0.001 0.002\n"
    "7 SIMPLE_RADIAL 320 240 300 160 120 -0.05\r\n"
    "9 OPENCV_FISHEYE 640 480 600 600 320 240 0 0 0 0\n";
/// 90° about z: (x, y, z) → (−y, x, z).
const char* const kImagesText =
    "# two lines an image\n"
    "3 0.70710678118654757 0 0 0.70710678118654757 1 2 3 1 second frame.png\n"
    "10 20 -1 30 40.5 17\n"
    "1 1 0 0 0 0 0 0.5 1 first.png\n"
    "\n";

template <typename T>
void Put(const T& value, std::string* bytes) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes->append(raw, sizeof(T));
}

std::string CamerasBytes() {
  std::string bytes;
  Put<uint64_t>(2, &bytes);
  Put<uint32_t>(1, &bytes);
  Put<int32_t>(1, &bytes);
  Put<uint64_t>(640, &bytes);
  Put<uint64_t>(480, &bytes);
  for (const double p : {600.0, 610.0, 320.0, 240.0}) Put(p, &bytes);
  Put<uint32_t>(4, &bytes);
  Put<int32_t>(5, &bytes);
  Put<uint64_t>(640, &bytes);
  Put<uint64_t>(480, &bytes);
  for (int i = 0; i < 8; ++i) Put(1.0 + i, &bytes);
  return bytes;
}

std::string ImagesBytes() {
  std::string bytes;
  Put<uint64_t>(2, &bytes);
  const auto image = [&](uint32_t id, const std::vector<double>& q_t, const std::string& name, uint64_t points) {
    Put(id, &bytes);
    for (const double x : q_t) Put(x, &bytes);
    Put<uint32_t>(1, &bytes);
    bytes += name + '\0';
    Put(points, &bytes);
    bytes.append(points * 24, '\1');
  };
  image(3, {std::sqrt(0.5), 0, 0, std::sqrt(0.5), 1, 2, 3}, "second frame.png", 2);
  image(1, {1, 0, 0, 0, 0, 0, 0.5}, "first.png", 0);
  return bytes;
}

void ExpectTheImages(const std::vector<ColmapImage>& images) {
  ASSERT_EQ(images.size(), 2U);
  EXPECT_EQ(images[0].name, "second frame.png");
  EXPECT_EQ(images[1].name, "first.png");
  EXPECT_EQ(images[1].camera_id, 1U);
  EXPECT_LT((MovedPoint(images[0].pose, {1, 0, 0}) - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
  EXPECT_LT((MovedPoint(images[1].pose, {1, 0, 0}) - Eigen::Vector3d(1, 0, 0.5)).norm(), 1e-12);
}

TEST(ColmapReader, CamerasAreOpenCvs) {
  const auto cameras = ColmapCamerasFromText(kCamerasText, "cameras.txt");
  ASSERT_EQ(cameras.size(), 4U);
  const Camera& pinhole = cameras.at(1).camera;
  EXPECT_EQ(pinhole.width, 640);
  EXPECT_EQ(pinhole.fy, 610);
  EXPECT_EQ(pinhole.cx, 319.5) << "COLMAP's pixels begin at the corner";
  const Camera& lens = cameras.at(2).camera;
  EXPECT_EQ(lens.distortion[1], -0.2);
  EXPECT_EQ(lens.distortion[3], 0.002);
  EXPECT_EQ(cameras.at(7).camera.fy, 300);
  EXPECT_EQ(cameras.at(7).camera.distortion[0], -0.05);
  EXPECT_FALSE(cameras.at(9).is_pinhole);
  EXPECT_EQ(cameras.at(9).model, "OPENCV_FISHEYE");
  const auto binary = ColmapCamerasFromBytes(CamerasBytes(), "cameras.bin");
  EXPECT_EQ(binary.at(1).camera.cx, 319.5);
  EXPECT_FALSE(binary.at(4).is_pinhole);
}

TEST(ColmapReader, ImagesInTextAndInBinaryAreTheSame) {
  ExpectTheImages(ColmapImagesFromText(kImagesText, "images.txt"));
  ExpectTheImages(ColmapImagesFromBytes(ImagesBytes(), "images.bin"));
}

TEST(ColmapReader, BinaryFilesWin) {
  const TemporaryFolder folder;
  EXPECT_FALSE(IsColmapFolder(folder.File("")));
  WriteFileAtomically(folder.File("images.txt"), kImagesText);
  WriteFileAtomically(folder.File("cameras.txt"), kCamerasText);
  EXPECT_TRUE(IsColmapFolder(folder.File("")));
  EXPECT_EQ(ReadColmapModel(folder.File("")).cameras.size(), 4U);
  WriteFileAtomically(folder.File("images.bin"), ImagesBytes());
  EXPECT_TRUE(ReadColmapModel(folder.File("")).cameras.empty()) << "cameras.bin is not there";
  WriteFileAtomically(folder.File("cameras.bin"), CamerasBytes());
  EXPECT_EQ(ReadColmapModel(folder.File("")).cameras.size(), 2U);
  EXPECT_EQ(ReadColmapModel(folder.File("images.txt")).cameras.size(), 4U);
}

TEST(ColmapReader, RefusesWhatIsNotColmaps) {
  const auto image = [](const std::string& text) {
    return FileErrorOf("images.txt", [&] { ColmapImagesFromText(text, "images.txt"); });
  };
  EXPECT_THAT(image("1 1 0 0 0 0 0 x 1 a.png\n\n"), HasSubstr("line 1"));
  EXPECT_THAT(image("1 1 0 0 0 0 0 0 1\n\n"), HasSubstr("NAME"));
  EXPECT_THAT(image("1 0.5 0 0 0 0 0 0 1 a.png\n\n"), HasSubstr("quaternion of length 0.5"));
  EXPECT_THAT(image("1 1 0 0 0 0 0 0 1 a.png\n2 1 0 0 0 0 0 0 1 b.png\n"), HasSubstr("line 2: 10 words"));
  const auto camera = [](const std::string& text) {
    return FileErrorOf("cameras.txt", [&] { ColmapCamerasFromText(text, "cameras.txt"); });
  };
  EXPECT_THAT(camera("1 PINHOLE 640 480 600 600 320\n"), HasSubstr("3 parameters of a PINHOLE, expected 4"));
  EXPECT_THAT(camera("1 LOCHKAMERA 640 480 600\n"), HasSubstr("model 'LOCHKAMERA'"));
  EXPECT_THAT(camera("1 PINHOLE 640 480 -600 600 320 240\n"), HasSubstr("focal length"));
  EXPECT_THAT(camera("1 PINHOLE 0 480 600 600 320 240\n"), HasSubstr("image size"));
  EXPECT_THAT(camera("1 PINHOLE 640 480 600 600 320 240\n1 PINHOLE 640 480 600 600 320 240\n"), HasSubstr("twice"));
  const TemporaryFolder folder;
  WriteFileAtomically(folder.File("images.txt"), "# nothing\n");
  EXPECT_THAT(FileErrorOf("images.txt", [&] { ReadColmapModel(folder.File("images.txt")); }), HasSubstr("no image"));
}

TEST(ColmapReader, RefusesBinaryFilesThatEndAnywhere) {
  const std::string images = ImagesBytes(), cameras = CamerasBytes();
  for (size_t n = 0; n < images.size(); ++n) {
    FileErrorOf("images.bin", [&] { ColmapImagesFromBytes(images.substr(0, n), "images.bin"); });
  }
  for (size_t n = 0; n < cameras.size(); ++n) {
    FileErrorOf("cameras.bin", [&] { ColmapCamerasFromBytes(cameras.substr(0, n), "cameras.bin"); });
  }
  std::string many = images;
  many[0] = '\xff';
  FileErrorOf("images.bin", [&] { ColmapImagesFromBytes(many, "images.bin"); });
  std::string unknown = cameras;
  unknown[12] = 99;
  EXPECT_THAT(FileErrorOf("cameras.bin", [&] { ColmapCamerasFromBytes(unknown, "cameras.bin"); }),
              HasSubstr("camera model 99"));
}

}  // namespace
}  // namespace bodyloom::colmap_reader_test
