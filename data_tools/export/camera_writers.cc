// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/camera_writers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

constexpr double kCornerOfPixel = 0.5;

}  // namespace

std::string ColmapCamerasText(const Camera& camera) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole && camera.width > 0 && camera.height > 0, "COLMAP: a ",
                 ToString(camera.model), " camera of ", camera.width, "x", camera.height,
                 " pixels, expected a pinhole camera with the size of its images");
  char text[512];
  std::snprintf(text, sizeof text, "1 %s %d %d %.17g %.17g %.17g %.17g",
                camera.HasDistortion() ? "FULL_OPENCV" : "PINHOLE", camera.width, camera.height, camera.fx, camera.fy,
                camera.cx + kCornerOfPixel, camera.cy + kCornerOfPixel);
  std::string out = std::string("# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n") + text;
  for (const double d : camera.distortion) {
    if (!camera.HasDistortion()) break;
    std::snprintf(text, sizeof text, " %.17g", d);
    out += text;
  }
  return out + "\n";
}

std::string ColmapImagesText(const ExportScene& scene) {
  std::string out = "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME, and a line of POINTS2D\n";
  char text[512];
  const ExportPerson& person = scene.people.front();
  for (size_t i = 0; i < person.seconds.size(); ++i) {
    const CameraPose pose = scene.CameraAt(person.seconds[i]);
    const Eigen::Quaterniond q(pose.camera_from_world_rotation);
    const Eigen::Vector3d& t = pose.camera_from_world_translation;
    std::snprintf(text, sizeof text, "%zu %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 frame_%06ld.png\n\n", i + 1,
                  q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), std::lround(person.seconds[i] * scene.fps));
    out += text;
  }
  return out;
}

std::string ColmapPointsText(const ExportScene& scene) {
  std::string out = "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]\n";
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

std::string Pose2SimCalibrationText(const std::string& name, const Camera& camera, const WorldFrame& world) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole && camera.width > 0 && camera.height > 0, "Pose2Sim: a ",
                 ToString(camera.model), " camera of ", camera.width, "x", camera.height,
                 " pixels, expected a pinhole camera with the size of its images");
  BODYLOOM_CHECK(!name.empty() && std::all_of(name.begin(), name.end(),
                                              [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; }),
                 "Pose2Sim: camera '", name, "', expected letters, digits, '_' and '-'");
  Eigen::Matrix3d ours_from_theirs;
  ours_from_theirs << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const CameraPose pose = world.camera_pose();
  const Eigen::Vector3d r = AxisAngleFromRotation(pose.camera_from_world_rotation * ours_from_theirs);
  const Eigen::Vector3d& t = pose.camera_from_world_translation;
  char text[1024];
  std::snprintf(text, sizeof text,
                "[%s]\nname = \"%s\"\nsize = [ %.1f, %.1f]\n"
                "matrix = [ [ %.17g, 0.0, %.17g], [ 0.0, %.17g, %.17g], [ 0.0, 0.0, 1.0]]\n"
                "distortions = [ %.17g, %.17g, %.17g, %.17g]\nrotation = [ %.17g, %.17g, %.17g]\n"
                "translation = [ %.17g, %.17g, %.17g]\nfisheye = false\n\n[metadata]\nadjusted = false\nerror = 0.0\n",
                name.c_str(), name.c_str(), double(camera.width), double(camera.height), camera.fx, camera.cx,
                camera.fy, camera.cy, camera.distortion[0], camera.distortion[1], camera.distortion[2],
                camera.distortion[3], r.x(), r.y(), r.z(), t.x(), t.y(), t.z());
  return text;
}

void WritePose2SimCalibration(const std::string& path, const std::string& name, const Camera& camera,
                              const WorldFrame& world) {
  WriteFileAtomically(path, Pose2SimCalibrationText(name, camera, world));
}

}  // namespace bodyloom
