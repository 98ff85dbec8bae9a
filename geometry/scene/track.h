// SPDX-License-Identifier: Apache-2.0
/// A motion of one body, and a track: a motion with its camera, frame status and uncertainty.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/world_frame.h"

namespace bodyloom {

/// T frames of SMPL-style parameters. The frame of `trans` and of the root rotation is that of the source (`y_up`
/// distinguishes worlds with y up from those with z up); tracks are in the camera frame.
struct Motion {
  std::string body;                ///< body family: "smpl" (24 joints), "smplh" (52), "smplx" (55)
  RowMatrixXd poses;               ///< T×3J axis-angle, radians
  MatrixX3d trans;                 ///< T×3 metres
  Eigen::VectorXd betas;           ///< B, or empty
  std::vector<double> timestamps;  ///< T seconds
  enum class Up { kY, kZ, kCamera } up = Up::kY;
  [[nodiscard]] int num_frames() const { return static_cast<int>(poses.rows()); }
  /// Returns true if frame t has a finite pose and translation.
  [[nodiscard]] bool HasPose(int t) const { return poses.row(t).allFinite() && trans.row(t).allFinite(); }
};

enum class FrameStatus : uint8_t {
  kTracked = 0,       ///< enough observations, fitted
  kWeak = 1,          ///< fitted, but with few or poor observations
  kInterpolated = 2,  ///< nothing observed: determined by the neighbours and the priors
  kLost = 3,          ///< no estimate (values are NaN)
};

std::string ToString(FrameStatus status);

/// The way in which a video is played to see a track's camera and time.
struct VideoPlayback {
  int turn_deg = 0;     ///< every frame is turned clockwise by 0, 90, 180 or 270 degrees
  double slowdown = 1;  ///< seconds of the video per second of the track: 8 if 240 frames a second are stored as 30
  bool operator==(const VideoPlayback&) const = default;
};

/// A Motion in the camera frame together with its camera. All positions in metres, camera frame. With a moving camera
/// they are in the scene (geometry/scene/camera_path.h): a static frame, to which every frame's camera is known.
struct Track {
  Motion motion;  ///< up = kCamera
  Camera camera;  ///< intrinsics shared by all frames
  /// T rigid motions of a moving camera, scene to camera; empty: the camera is static, and its frame is the scene.
  std::vector<CameraPose> camera_from_scene;
  MatrixX3d weak_camera;                  ///< T×3 (s, tx, ty) per frame for weak perspective; T×0 rows otherwise
  std::vector<FrameStatus> frame_status;  ///< T
  std::vector<MatrixX3d> joints;          ///< T of J×3
  std::vector<MatrixX3d> coco17;          ///< T of 17×3
  /// T×J standard deviation of each joint's position about the middle of the hips, metres, one axis (NaN: unknown).
  RowMatrixXd joint_sigma;
  Eigen::VectorXd root_sigma;  ///< T: that of the mid-hip's own position; or empty
  /// Vertical and ground; absent when unknown (render/view/floor.h then assumes a level camera).
  std::optional<WorldFrame> world;
  /// T heights of the level that supports the person over the world's ground, metres: 0 on it, else on a box, stairs or
  /// a stage. Frames between two levels have that of the one before or after. Empty: the ground alone.
  Eigen::VectorXd level_m;
  VideoPlayback playback;  ///< of the video that the track was made from
  [[nodiscard]] int num_frames() const { return motion.num_frames(); }
  [[nodiscard]] bool HasMovingCamera() const { return !camera_from_scene.empty(); }
  /// The camera of frame t: `camera`, with (s, tx, ty) of that frame for weak perspective.
  [[nodiscard]] Camera CameraAt(int t) const;
  /// Returns true if frame t has a finite pose and camera.
  [[nodiscard]] bool HasResult(int t) const;
  /// The level of frame t over the world's ground, metres.
  [[nodiscard]] double LevelAt(int t) const { return level_m.size() > 0 ? level_m[t] : 0; }
};

/// Throws std::invalid_argument, naming the caller, unless there is a frame, poses, trans and timestamps have T rows
/// each, poses 3J columns, and all is finite.
void CheckMotion(const Motion& motion, const char* caller);

/// Throws std::runtime_error "where: …" when the track's poses have more joints than the body.
void RequireTrackFitsBody(const Track& track, const BodyModel& body, const std::string& where);

}  // namespace bodyloom
