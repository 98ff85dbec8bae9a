// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/export_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "data_tools/motion/motion_tools.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom {
namespace {

constexpr double kOneFrameRate = 30;
constexpr double kLongestGap = 1.5;  ///< steps between frames without a gap

/// Poses of a moving camera at the moments of all tracks.
void AddCameraKeys(std::span<const Track* const> tracks, ExportScene* scene) {
  std::map<double, CameraPose> at;
  for (const Track* track : tracks) {
    BODYLOOM_CHECK(track->HasMovingCamera() == tracks[0]->HasMovingCamera(),
                   "export: the camera of one track moves and that of another stands still, expected one clip's");
    for (size_t t = 0; t < track->camera_from_scene.size(); ++t) {
      at.emplace(track->motion.timestamps[t] - scene->start_s,
                 Compose(track->camera_from_scene[t], scene->world.camera_pose()));
    }
  }
  for (const auto& [seconds, pose] : at) {
    if (seconds >= 0) scene->camera_keys.push_back({seconds, pose});
  }
}

}  // namespace

Eigen::Vector3d PersonColour(size_t number) {
  static const std::array<Eigen::Vector3d, 4> colours = {
      Eigen::Vector3d(0.62, 0.42, 0.33), Eigen::Vector3d(0.26, 0.42, 0.62), Eigen::Vector3d(0.30, 0.52, 0.36),
      Eigen::Vector3d(0.55, 0.45, 0.60)};
  return colours[number % colours.size()];
}

BodyPose PoseInWorld(const WorldFrame& world, const Eigen::Vector3d& rest_pelvis, BodyPose pose) {
  return MovedPose({world.rotation, world.translation}, rest_pelvis, std::move(pose));
}

Motion MotionInWorld(const WorldFrame& world, const Eigen::Vector3d& rest_pelvis, const Motion& motion) {
  Motion turned = motion;
  turned.up = Motion::Up::kY;
  for (int t = 0; t < motion.num_frames(); ++t) {
    if (!motion.HasPose(t)) continue;
    const Eigen::Matrix3d root = world.rotation * RotationFromAxisAngle(motion.poses.block<1, 3>(t, 0).transpose());
    turned.poses.block<1, 3>(t, 0) = AxisAngleFromRotation(root).transpose();
    const Eigen::Vector3d pelvis = rest_pelvis + motion.trans.row(t).transpose();
    turned.trans.row(t) = (world.PointFromCamera(pelvis) - rest_pelvis).transpose();
  }
  return turned;
}

CameraPose ExportScene::CameraAt(double seconds) const {
  if (camera_keys.empty()) return world.camera_pose();
  return std::min_element(camera_keys.begin(), camera_keys.end(),
                          [&](const ExportCameraKey& a, const ExportCameraKey& b) {
                            return std::abs(a.seconds - seconds) < std::abs(b.seconds - seconds);
                          })
      ->camera_from_world;
}

std::vector<PresenceKey> ExportScene::PresenceOf(const ExportPerson& person) const {
  std::vector<PresenceKey> keys;
  const auto push = [&](double seconds, bool present) {
    // Files hold times in single precision.
    if (keys.empty() || (keys.back().present != present && float(seconds) > float(keys.back().seconds))) {
      keys.push_back({seconds, present});
    }
  };
  const double step = 1 / fps;
  if (person.seconds.front() > 0.5 * step) push(0, false);
  push(person.seconds.front(), true);
  for (size_t t = 1; t < person.seconds.size(); ++t) {
    if (person.seconds[t] - person.seconds[t - 1] <= kLongestGap * step) continue;
    push(person.seconds[t - 1] + 0.5 * step, false);
    push(person.seconds[t], true);
  }
  if (person.seconds.back() < duration_s - 0.5 * step) push(person.seconds.back() + 0.5 * step, false);
  if (keys.size() < 2) keys.clear();
  return keys;
}

ExportScene MakeExportScene(std::span<const BodyModel* const> bodies, std::span<const Track* const> tracks,
                            const WorldFrame& world) {
  BODYLOOM_CHECK(!tracks.empty() && bodies.size() == tracks.size(), "export: ", bodies.size(), " bodies for ",
                 tracks.size(), " tracks");
  ExportScene scene;
  scene.world = world;
  scene.camera = tracks[0]->camera;
  const double fps = FrameRateWithoutGaps(tracks[0]->motion);
  scene.fps = fps > 0 ? fps : kOneFrameRate;
  scene.start_s = std::numeric_limits<double>::infinity();
  double end_s = -scene.start_s;
  for (size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = *tracks[i];
    const BodyModel& body = *bodies[i];
    ExportPerson person{"person_" + std::to_string(i),       &body, track.motion.betas,
                        body.RestJoints(track.motion.betas), {},    {}};
    const Eigen::Vector3d pelvis = person.rest_joints.row(0).transpose();
    for (int t = 0; t < track.num_frames(); ++t) {
      if (!track.HasResult(t)) continue;
      const BodyPose pose =
          PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
      person.poses.push_back(PoseInWorld(world, pelvis, pose));
      person.seconds.push_back(track.motion.timestamps.at(t));
    }
    BODYLOOM_CHECK(!person.poses.empty(), "export: every frame of track ", i, " is lost, there is nobody to write");
    scene.start_s = std::min(scene.start_s, person.seconds.front());
    end_s = std::max(end_s, person.seconds.back());
    scene.people.push_back(std::move(person));
  }
  for (ExportPerson& person : scene.people) {
    for (double& seconds : person.seconds) seconds -= scene.start_s;
  }
  AddCameraKeys(tracks, &scene);
  scene.duration_s = end_s - scene.start_s;
  return scene;
}

}  // namespace bodyloom
