// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/camera_writers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <set>

#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

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

constexpr double kCornerOfPixel = 0.5;

}  // namespace

std::string ColmapCamerasHeading() { return "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"; }

std::string ColmapImagesHeading() {
  return "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME, and a line of POINTS2D\n";
}

std::string ColmapPointsHeading() { return "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]\n"; }

std::string ColmapCameraLine(int camera_id, const Camera& camera) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole && camera.width > 0 && camera.height > 0, "COLMAP: a ",
                 ToString(camera.model), " camera of ", camera.width, "x", camera.height,
                 " pixels, expected a pinhole camera with the size of its images");
  char text[512];
  std::snprintf(text, sizeof text, "%d %s %d %d %.17g %.17g %.17g %.17g", camera_id,
                camera.HasDistortion() ? "FULL_OPENCV" : "PINHOLE", camera.width, camera.height, camera.fx, camera.fy,
                camera.cx + kCornerOfPixel, camera.cy + kCornerOfPixel);
  std::string out = text;
  for (const double d : camera.distortion) {
    if (!camera.HasDistortion()) break;
    std::snprintf(text, sizeof text, " %.17g", d);
    out += text;
  }
  return out + "\n";
}

std::string ColmapImageLine(size_t image_id, const CameraPose& camera_from_world, int camera_id,
                            const std::string& name) {
  const Eigen::Quaterniond q(camera_from_world.camera_from_world_rotation);
  const Eigen::Vector3d& t = camera_from_world.camera_from_world_translation;
  char text[512];
  std::snprintf(text, sizeof text, "%zu %.17g %.17g %.17g %.17g %.17g %.17g %.17g %d ", image_id, q.w(), q.x(), q.y(),
                q.z(), t.x(), t.y(), t.z(), camera_id);
  return text + name + "\n\n";
}

std::string ColmapCamerasText(const Camera& camera) { return ColmapCamerasHeading() + ColmapCameraLine(1, camera); }

std::string ColmapImagesText(const ExportScene& scene) {
  std::string out = ColmapImagesHeading();
  const ExportPerson& person = scene.people.front();
  for (size_t i = 0; i < person.seconds.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%06ld.png", std::lround(person.seconds[i] * scene.fps));
    out += ColmapImageLine(i + 1, scene.CameraAt(person.seconds[i]), 1, name);
  }
  return out;
}

std::string ColmapPointsText(const ExportScene& scene) {
  std::string out = ColmapPointsHeading();
  char text[256];
  size_t id = 0;
  for (const ExportPerson& person : scene.people) {
    const MatrixX3d vertices = PoseVertices(*person.body, person.betas, person.poses.front());
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      std::snprintf(text, sizeof text, "%zu %.7g %.7g %.7g 128 128 128 0\n", ++id, vertices(v, 0), vertices(v, 1),
                    vertices(v, 2));
      out += text;
    }
  }
  return out;
}

void WriteColmap(const std::string& folder, const ExportScene& scene) {
  const std::filesystem::path path(folder);
  const std::string cameras = ColmapCamerasText(scene.camera);
  WriteFileAtomically((path / "cameras.txt").string(), cameras);
  WriteFileAtomically((path / "images.txt").string(), ColmapImagesText(scene));
  WriteFileAtomically((path / "points3D.txt").string(), ColmapPointsText(scene));
}

std::string Pose2SimCameraTable(const std::string& name, const Camera& camera, const CameraPose& camera_from_world) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole && camera.width > 0 && camera.height > 0, "Pose2Sim: a ",
                 ToString(camera.model), " camera of ", camera.width, "x", camera.height,
                 " pixels, expected a pinhole camera with the size of its images");
  BODYLOOM_CHECK(!name.empty() && std::all_of(name.begin(), name.end(),
                                              [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; }),
                 "Pose2Sim: camera '", name, "', expected letters, digits, '_' and '-'");
  const Eigen::Vector3d r = AxisAngleFromRotation(camera_from_world.camera_from_world_rotation);
  const Eigen::Vector3d& t = camera_from_world.camera_from_world_translation;
  char text[1024];
  std::snprintf(text, sizeof text,
                "[%s]\nname = \"%s\"\nsize = [ %.1f, %.1f]\n"
                "matrix = [ [ %.17g, 0.0, %.17g], [ 0.0, %.17g, %.17g], [ 0.0, 0.0, 1.0]]\n"
                "distortions = [ %.17g, %.17g, %.17g, %.17g]\nrotation = [ %.17g, %.17g, %.17g]\n"
                "translation = [ %.17g, %.17g, %.17g]\nfisheye = false\n\n",
                name.c_str(), name.c_str(), double(camera.width), double(camera.height), camera.fx, camera.cx,
                camera.fy, camera.cy, camera.distortion[0], camera.distortion[1], camera.distortion[2],
                camera.distortion[3], r.x(), r.y(), r.z(), t.x(), t.y(), t.z());
  return text;
}

std::string Pose2SimMetadata() { return "[metadata]\nadjusted = false\nerror = 0.0\n"; }

std::string Pose2SimCalibrationText(const std::string& name, const Camera& camera, const WorldFrame& world) {
  Eigen::Matrix3d ours_from_theirs;
  ours_from_theirs << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  CameraPose pose = world.camera_pose();
  pose.camera_from_world_rotation = pose.camera_from_world_rotation * ours_from_theirs;
  return Pose2SimCameraTable(name, camera, pose) + Pose2SimMetadata();
}

void WritePose2SimCalibration(const std::string& path, const std::string& name, const Camera& camera,
                              const WorldFrame& world) {
  WriteFileAtomically(path, Pose2SimCalibrationText(name, camera, world));
}

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
