// SPDX-License-Identifier: Apache-2.0
/// A scene of people in their world, the input of the writers of this folder.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/track.h"
#include "geometry/scene/world_frame.h"

namespace bodyloom {

struct ExportPerson {
  std::string name;                 ///< "person_0", …: letters, digits and underscores
  const BodyModel* body = nullptr;  ///< borrowed
  Eigen::VectorXd betas;
  MatrixX3d rest_joints;        ///< J×3, of the shape
  std::vector<double> seconds;  ///< times of the frames below, since the scene's start
  std::vector<BodyPose> poses;  ///< world frame; lost frames are left out
};

/// Pose of a moving camera at one moment.
struct ExportCameraKey {
  double seconds = 0;  ///< since the scene's start
  CameraPose camera_from_world;
};

/// From this moment on a person is there, or is not.
struct PresenceKey {
  double seconds = 0;  ///< since the scene's start
  bool present = true;
};

struct ExportScene {
  WorldFrame world;
  Camera camera;  ///< of the clip; a width of 0: the image size is unknown
  std::vector<ExportCameraKey>
      camera_keys;     ///< of a moving camera, increasing in time; empty: it is static at world.camera_pose()
  double fps = 30;     ///< of the first person's clock
  double start_s = 0;  ///< the earliest frame's time in the clip
  double duration_s = 0;
  std::vector<ExportPerson> people;

  /// Returns the key nearest in time to a moment of the scene.
  [[nodiscard]] CameraPose CameraAt(double seconds) const;
  /// Returns when a person comes and goes, from the scene's start on, increasing; empty if the person is always there.
  /// Somebody lost for more than one and a half steps goes half a step after the last frame.
  [[nodiscard]] std::vector<PresenceKey> PresenceOf(const ExportPerson& person) const;
};

/// Colour of a person without a texture: red, green, blue in [0, 1]. Four colours take turns.
Eigen::Vector3d PersonColour(size_t number);

/// Transforms to the world the pose of a body whose pelvis joint rests at `rest_pelvis`, : with R, t of the world,
/// R_root ← R·R_root and trans ← R(J0 + trans) + t − J0.
BodyPose PoseInWorld(const WorldFrame& world, const Eigen::Vector3d& rest_pelvis, BodyPose pose_in_camera);

/// The same for a motion in the camera frame; its lost frames stay NaN. The result has y up.
Motion MotionInWorld(const WorldFrame& world, const Eigen::Vector3d& rest_pelvis, const Motion& motion);

/// Makes a scene of the tracks of one clip, each with the body of the same index. Throws std::invalid_argument when
/// there are none, bodies and tracks differ in number, a track has more joints than its body or no frame with a result,
/// or the camera moves in one track and is static in another.
ExportScene MakeExportScene(std::span<const BodyModel* const> bodies, std::span<const Track* const> tracks,
                            const WorldFrame& world);

}  // namespace bodyloom
