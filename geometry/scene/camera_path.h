// SPDX-License-Identifier: Apache-2.0
/// A camera that moves: where it stood at some moments of a clip, and what that makes of points and poses.
///
/// The frame in which a moving camera's clip is told is its *scene*: one that stands still, the frame that the camera
/// had first. camera_from_scene is then one rigid motion a frame (a CameraPose whose world is the scene), and whatever
/// is projected goes through that of its frame. No such motions: the camera stands still, and scene and camera are one.
#pragma once

#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// N moments with a pose each; between them the camera turns along geodesics and moves along straight lines.
struct CameraPath {
  std::vector<double> timestamps;  ///< N seconds, strictly increasing
  std::vector<CameraPose> poses;   ///< N, camera from world: any frame that stands still
};

/// a_from_c = a_from_b · b_from_c.
CameraPose Compose(const CameraPose& a_from_b, const CameraPose& b_from_c);
/// world_from_camera of camera_from_world.
CameraPose Inverse(const CameraPose& pose);
Eigen::Vector3d MovedPoint(const CameraPose& target_from_source, const Eigen::Vector3d& point_in_source);
/// Each row a point.
MatrixX3d MovedPoints(const CameraPose& target_from_source, const MatrixX3d& points_in_source);
/// Where a camera's centre is in its world: −Rᵀt.
Eigen::Vector3d CentreOf(const CameraPose& camera_from_world);

/// From a (s = 0) to b (s = 1): the centre along a line, the rotation along a geodesic.
CameraPose InterpolatePoses(const CameraPose& a, const CameraPose& b, double s);

/// The pose of a body whose pelvis joint rests at `rest_pelvis`, in another frame: R_root ← R·R_root and
/// trans ← R(J0 + trans) + t − J0, because the root turns about the pelvis J0 and not about the origin.
BodyPose MovedPose(const CameraPose& target_from_source, const Eigen::Vector3d& rest_pelvis, BodyPose pose);

/// The same for every frame of a motion, by its own target_from_source (T of them) or by one for all; frames without a
/// pose stay as they are. `up` is copied. Throws std::invalid_argument for another number of them.
Motion MovedMotion(const BodyModel& body, const Motion& motion, std::span<const CameraPose> target_from_source);

struct CameraPathLimits {
  double max_gap_s = 1;       ///< between two poses of the path that frames lie between
  double max_beyond_s = 0.1;  ///< before its first and after its last pose: the camera is taken to stand there
};
struct SampledCameraPath {
  std::vector<CameraPose>
      camera_from_scene;  ///< of each moment asked for; the scene is the frame of the path's first pose
  int interpolated = 0;   ///< moments more than a millisecond from a pose of the path
  int beyond = 0;         ///< moments before its first or after its last pose
};
/// The path at these moments, seconds. Throws std::invalid_argument when the path has no pose, unequal numbers of times
/// and poses or times that do not rise, and where a limit is exceeded: the moment and the gap are named.
SampledCameraPath SampleCameraPath(const CameraPath& path, std::span<const double> timestamps,
                                   const CameraPathLimits& limits = {});

/// The poses with translations times `scale`, for a path without a length.
std::vector<CameraPose> ScaledPath(std::span<const CameraPose> camera_from_scene, double scale);

/// The track as the camera saw it: poses, joints and coco17 of each frame in the camera frame of that frame, and no
/// path. For whatever draws or measures in pictures; a track of a camera that stands still comes back as it is. What
/// moves between its frames is then the camera's motion too.
Track TrackInCameras(const BodyModel& body, const Track& track);

}  // namespace bodyloom
