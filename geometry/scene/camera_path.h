// SPDX-License-Identifier: Apache-2.0
/// Paths of moving cameras: poses at some moments of a clip, and the transformation of points and body poses by them.
///
/// The frame in which a moving camera's clip is described is its *scene*: a static frame, that of the camera at first.
/// camera_from_scene is then one rigid motion per frame (a CameraPose whose world is the scene), and points are
/// projected through that of their frame. Without such motions the camera is static, and scene and camera frame are the
/// same.
#pragma once

#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Poses at N moments; between them the camera rotates along geodesics and moves along straight lines.
struct CameraPath {
  std::vector<double> timestamps;  ///< N seconds, strictly increasing
  std::vector<CameraPose> poses;   ///< N, camera from world, which may be any static frame
};

/// a_from_c = a_from_b · b_from_c.
CameraPose Compose(const CameraPose& a_from_b, const CameraPose& b_from_c);
/// Returns world_from_camera of camera_from_world.
CameraPose Inverse(const CameraPose& pose);
Eigen::Vector3d MovedPoint(const CameraPose& target_from_source, const Eigen::Vector3d& point_in_source);
/// Transforms points, one per row.
MatrixX3d MovedPoints(const CameraPose& target_from_source, const MatrixX3d& points_in_source);
/// Position of the camera centre in its world: −Rᵀt.
Eigen::Vector3d CentreOf(const CameraPose& camera_from_world);

/// Interpolates from a (s = 0) to b (s = 1): the centre along a line, the rotation along a geodesic.
CameraPose InterpolatePoses(const CameraPose& a, const CameraPose& b, double s);

/// The pose of a body whose pelvis joint rests at `rest_pelvis`, in another frame: R_root ← R·R_root and
/// trans ← R(J0 + trans) + t − J0, because the root turns about the pelvis J0 and not about the origin.
BodyPose MovedPose(const CameraPose& target_from_source, const Eigen::Vector3d& rest_pelvis, BodyPose pose);

/// The same for every frame of a motion, by one target_from_source per frame (T) or one for all; frames without a pose
/// are not changed. `up` is copied. Throws std::invalid_argument for another number of them.
Motion MovedMotion(const BodyModel& body, const Motion& motion, std::span<const CameraPose> target_from_source);

struct CameraPathLimits {
  double max_gap_s = 1;       ///< longest gap of the path in which frames may lie
  double max_beyond_s = 0.1;  ///< before its first and after its last pose, where the pose is held
};
struct SampledCameraPath {
  std::vector<CameraPose>
      camera_from_scene;  ///< of each requested moment; the scene is the frame of the path's first pose
  int interpolated = 0;   ///< moments more than a millisecond from a pose of the path
  int beyond = 0;         ///< moments before its first or after its last pose
};
/// Samples the path at these moments, seconds. Throws std::invalid_argument when the path has no pose, unequal numbers
/// of times and poses or times that do not increase, or when a limit is exceeded (naming the moment and the gap).
SampledCameraPath SampleCameraPath(const CameraPath& path, std::span<const double> timestamps,
                                   const CameraPathLimits& limits = {});

/// The poses with translations multiplied by `scale`, for a path of unknown scale.
std::vector<CameraPose> ScaledPath(std::span<const CameraPose> camera_from_scene, double scale);

/// The track in camera frames: poses, joints and coco17 of each frame in the camera frame of that frame, without a
/// path, for rendering and measurements in images. A track of a static camera is returned unchanged. Differences
/// between frames then include the camera's motion.
Track TrackInCameras(const BodyModel& body, const Track& track);

}  // namespace bodyloom
