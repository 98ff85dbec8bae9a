// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/rig_writers.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include <opencv2/core.hpp>

#include "data_tools/export/camera_writers.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

void CheckCamerasToWrite(const std::vector<NamedCamera>& cameras) {
  BODYLOOM_CHECK(!cameras.empty(), "no cameras to write");
  std::set<std::string> names;
  for (const NamedCamera& named : cameras) {
    BODYLOOM_CHECK(named.camera.model == CameraModel::kPinhole && named.camera.width > 0 && named.camera.height > 0,
                   "a ", ToString(named.camera.model), " camera of ", named.camera.width, "x", named.camera.height,
                   " pixels, expected a pinhole camera with the size of its images");
    BODYLOOM_CHECK(!named.name.empty(), "a camera without a name, expected one");
    BODYLOOM_CHECK(names.insert(named.name).second, "two cameras are called '", named.name,
                   "', expected distinct names");
  }
}

/// True if a coefficient from `begin` on is not zero.
bool HasCoefficientsFrom(const Camera& camera, int begin) {
  return std::any_of(camera.distortion.begin() + begin, camera.distortion.end(), [](double d) { return d != 0; });
}

cv::Mat MatOf(const Eigen::MatrixXd& matrix) {
  cv::Mat mat(static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols()), CV_64F);
  for (int r = 0; r < mat.rows; ++r) {
    for (int c = 0; c < mat.cols; ++c) mat.at<double>(r, c) = matrix(r, c);
  }
  return mat;
}

}  // namespace

std::string Pose2SimRigText(const std::vector<NamedCamera>& cameras) {
  CheckCamerasToWrite(cameras);
  std::string text;
  for (const NamedCamera& named : cameras) {
    BODYLOOM_CHECK(!HasCoefficientsFrom(named.camera, 4), "Pose2Sim: camera ", named.name,
                   " has distortion coefficients beyond k1 k2 p1 p2, which Calib.toml does not hold");
    text += Pose2SimCameraTable(named.name, named.camera, named.pose);
  }
  return text + Pose2SimMetadata();
}

std::string OpenCvRigText(const std::vector<NamedCamera>& cameras) {
  CheckCamerasToWrite(cameras);
  cv::FileStorage storage(".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  storage << "cameras"
          << "[";
  for (const NamedCamera& named : cameras) {
    const Camera& camera = named.camera;
    const int coefficients = HasCoefficientsFrom(camera, 5) ? 8 : 5;
    storage << "{"
            << "name" << named.name << "image_width" << camera.width << "image_height" << camera.height
            << "camera_matrix" << MatOf(camera.K()) << "distortion_coefficients"
            << MatOf(Eigen::Map<const Eigen::RowVectorXd>(camera.distortion.data(), coefficients)) << "rotation"
            << MatOf(named.pose.camera_from_world_rotation) << "translation"
            << MatOf(named.pose.camera_from_world_translation) << "}";
  }
  storage << "]";
  return storage.releaseAndGetString();
}

void WriteColmapRig(const std::string& folder, const std::vector<NamedCamera>& cameras) {
  CheckCamerasToWrite(cameras);
  std::string camera_lines = ColmapCamerasHeading(), images = ColmapImagesHeading();
  for (size_t i = 0; i < cameras.size(); ++i) {
    const int id = static_cast<int>(i) + 1;
    camera_lines += ColmapCameraLine(id, cameras[i].camera);
    images += ColmapImageLine(i + 1, cameras[i].pose, id, cameras[i].name + ".png");
  }
  const std::filesystem::path path(folder);
  WriteFileAtomically((path / "cameras.txt").string(), camera_lines);
  WriteFileAtomically((path / "images.txt").string(), images);
  WriteFileAtomically((path / "points3D.txt").string(), ColmapPointsHeading());
}

}  // namespace bodyloom
