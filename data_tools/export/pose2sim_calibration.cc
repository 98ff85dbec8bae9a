// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/export/pose2sim_calibration.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/rotation.h"

namespace bodyloom {

std::string Pose2SimCalibrationText(const std::string& name, const Camera& camera, const WorldFrame& world) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole && camera.width > 0 && camera.height > 0, "Pose2Sim: a ",
                 ToString(camera.model), " camera of ", camera.width, "x", camera.height,
                 " pixels, expected a pinhole camera with the size of its pictures");
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
