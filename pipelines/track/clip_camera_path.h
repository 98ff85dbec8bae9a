// SPDX-License-Identifier: Apache-2.0
/// Poses of a moving camera at the clip's frames, from the path that a request names.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "data_tools/observations/load_camera_path.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/track/track_request.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// Report of the use of a camera path.
struct CameraPathReport {
  std::string file;             ///< empty: the camera is static
  int poses = 0;                ///< poses within the clip's time
  int interpolated = 0;         ///< frames between two poses of the path
  int beyond = 0;               ///< frames before its first or after its last pose
  bool by_sorted_name = false;  ///< images are matched by sorted name, as their names have no numbers
};

/// Interpolates camera_from_scene at the frames' times `seconds`; `clip_seconds` are the times of the whole clip.
/// Throws std::runtime_error naming the file when the frames are not on the path, or too far from its poses.
std::vector<CameraPose> CamerasAt(const TrackSettings& request, const RecordedCameraPath& path,
                                  std::span<const double> clip_seconds, std::span<const double> seconds,
                                  CameraPathReport* report);

/// Value of TrackSequenceInput::camera_scale_m: the request's; 1 for a path in metres; otherwise 0.
double CameraScaleOf(const SceneRequest& request, const RecordedCameraPath& path);

/// Two lines with the number of poses, and the scale and its source; empty for a static camera.
std::string ToText(const CameraPathReport& report, const CameraPathSummary& solved);
/// Warning for a camera assumed to be static: one line if feet that the lifter labels as standing move faster than they
/// do under a static camera (docs/lab/moving_camera.md); otherwise empty.
std::string MovingCameraWarning(const CameraPathSummary& solved, const GroundSummary& ground);

/// The report's fields, and the scale and its source, as JSON.
nlohmann::ordered_json ToJson(const CameraPathReport& report, const CameraPathSummary& solved);

}  // namespace bodyloom
