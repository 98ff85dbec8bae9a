// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/world_frame.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr std::array<const char*, 5> kWorldSourceNames = {"level camera assumed", "vertical", "ground",
                                                          "several people", "given"};
constexpr double kMinHeading = 0.1;  ///< sine of the 6° off the vertical

}  // namespace

std::string ToString(WorldSource source) { return kWorldSourceNames.at(static_cast<size_t>(source)); }

WorldSource WorldSourceFromString(const std::string& text) {
  for (size_t i = 0; i < kWorldSourceNames.size(); ++i) {
    if (text == kWorldSourceNames[i]) return static_cast<WorldSource>(i);
  }
  BODYLOOM_CHECK(false, "'", text,
                 "', expected how a world was found: ground, several people, vertical, given or level "
                 "camera assumed");
  return WorldSource::kLevelCamera;
}

MatrixX3d WorldFrame::PointsFromCamera(const MatrixX3d& points_in_camera) const {
  return (points_in_camera * rotation.transpose()).rowwise() + translation.transpose();
}

CameraPose WorldFrame::camera_pose() const {
  return {.camera_from_world_rotation = rotation.transpose(),
          .camera_from_world_translation = -(rotation.transpose() * translation)};
}

std::string WorldFrame::BriefReport() const {
  std::string text;
  switch (source) {
    case WorldSource::kLevelCamera:
      text = "y up as if the camera were level (assumed), the ground under the lowest joint";
      break;
    case WorldSource::kVertical:
      text = "y up by the clip's vertical, the ground under the lowest joint";
      break;
    case WorldSource::kGround:
      text = "y up by the ground under this person's feet";
      break;
    case WorldSource::kPeople:
      text = "y up by the ground under several people's feet";
      break;
    case WorldSource::kGiven:
      text = "y up as given";
      break;
  }
  char number[64];
  if (std::isfinite(vertical_sigma_deg)) {
    std::snprintf(number, sizeof number, ", vertical within %.1f deg", vertical_sigma_deg);
    text += number;
  }
  if (std::isfinite(height_sigma_m)) {
    std::snprintf(number, sizeof number, ", height within %.3f m", height_sigma_m);
    text += number;
  }
  std::snprintf(number, sizeof number, "; camera at %.2f m", camera_height_m());
  return text + number;
}

WorldFrame WorldOverGround(const Vector3d& up_in_camera, double camera_height_m) {
  BODYLOOM_CHECK(up_in_camera.allFinite() && up_in_camera.norm() > 0 && std::isfinite(camera_height_m),
                 "world: vertical (", up_in_camera.transpose(), "), camera height ", camera_height_m,
                 ", expected a direction and a number");
  const Vector3d up = up_in_camera.normalized();
  Vector3d ahead = Vector3d::UnitZ() - up.z() * up;
  if (ahead.norm() < kMinHeading) {
    // Looking down, the image's upper edge is ahead; looking up, its lower one.
    const Vector3d edge = up.z() < 0 ? Vector3d(0, -1, 0) : Vector3d(0, 1, 0);
    ahead = edge - up.dot(edge) * up;
  }
  WorldFrame world;
  world.rotation.row(1) = up.transpose();
  world.rotation.row(2) = -ahead.normalized().transpose();
  world.rotation.row(0) = world.rotation.row(1).cross(world.rotation.row(2));
  world.translation = Vector3d(0, camera_height_m, 0);
  return world;
}

}  // namespace bodyloom
