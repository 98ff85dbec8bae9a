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
  std::string file;             ///< empty: none was given
  int poses = 0;                ///< poses within the clip's time
  int interpolated = 0;         ///< frames between two poses of the path
  int beyond = 0;               ///< frames before its first or after its last pose
  bool by_sorted_name = false;  ///< images are matched by sorted name, as their names have no numbers

  // Of the search for motion in the video (found_camera_motion.h).
  std::string motion;         ///< kind and evidence; empty: it was not looked for
  bool is_still = false;      ///< the background rests
  bool found = false;         ///< the path is that of the search
  bool goes = false;          ///< it goes from place to place; otherwise it turns in place
  double turned_deg = 0;      ///< largest rotation of a path that was found
  double sigma_deg = 0;       ///< largest standard deviation of its rotations, about an axis
  double sigma_place = 0;     ///< median σ of its places, as a share of the largest distance from the first
  int background_points = 0;  ///< placed in space by the search

  [[nodiscard]] bool any() const { return found || !file.empty(); }
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
/// do under a static camera (docs/lab/moving_camera.md), unless the search in the video said what it does.
std::string MovingCameraWarning(const CameraPathReport& report, const CameraPathSummary& solved,
                                const GroundSummary& ground);

/// The report's fields, and the scale and its source, as JSON.
nlohmann::ordered_json ToJson(const CameraPathReport& report, const CameraPathSummary& solved);

}  // namespace bodyloom
