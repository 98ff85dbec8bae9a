// SPDX-License-Identifier: Apache-2.0
/// The path of a clip's camera as a request names it, at the clip's frames.
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

/// What became of a path: for the report.
struct CameraPathReport {
  std::string file;             ///< empty: the camera stands still
  int poses = 0;                ///< in the clip's time
  int interpolated = 0;         ///< frames between two poses of the path
  int beyond = 0;               ///< frames before its first or after its last pose
  bool by_sorted_name = false;  ///< the pictures' names have no number, they were counted
};

/// camera_from_scene of each of the frames, which are at `clip_seconds` (the whole clip's), at `seconds`. Throws
/// std::runtime_error naming the file when they are not on the path, or too far from what is known of it.
std::vector<CameraPose> CamerasAt(const TrackSettings& request, const RecordedCameraPath& path,
                                  std::span<const double> clip_seconds, std::span<const double> seconds,
                                  CameraPathReport* report);

/// TrackSequenceInput::camera_scale_m: the request's, 1 for a path in metres, else 0.
double CameraScaleOf(const SceneRequest& request, const RecordedCameraPath& path);

/// Two lines: how many poses, and the scale and how it was found; nothing for a camera that stands still.
std::string ToText(const CameraPathReport& report, const CameraPathSummary& solved);
/// Of a camera that is said to stand still: empty, or one line when feet that the lifter calls standing move faster
/// than they do under such a camera (docs/lab/moving_camera.md).
std::string MovingCameraWarning(const CameraPathSummary& solved, const GroundSummary& ground);

// What became of a camera's path, for a program.

/// The report's fields, and the scale and how it was found.
nlohmann::ordered_json ToJson(const CameraPathReport& report, const CameraPathSummary& solved);

}  // namespace bodyloom
