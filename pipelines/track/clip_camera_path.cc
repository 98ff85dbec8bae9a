// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/clip_camera_path.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "geometry/base/check.h"
#include "pipelines/report_text.h"

namespace bodyloom {
namespace {

/// m/s: above all clips of cameras on a tripod, below those of cameras that move (docs/lab/moving_camera.md).
constexpr double kStandingStill = 0.3;

}  // namespace

std::vector<CameraPose> CamerasAt(const TrackSettings& request, const RecordedCameraPath& path,
                                  std::span<const double> clip_seconds, std::span<const double> seconds,
                                  CameraPathReport* report) {
  if (request.from_s > 0 && !path.frames.empty() && request.camera_path_first < 0) {
    throw std::runtime_error(request.camera_path +
                             ": its frames are numbered, and with --from the first of them is not known; give "
                             "--camera-path-first");
  }
  const CameraPath on_clock =
      CameraPathOnClock(path, clip_seconds, {request.camera_path_first, request.camera_path_fps}, request.camera_path);
  SampledCameraPath sampled;
  try {
    sampled = SampleCameraPath(on_clock, seconds);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(request.camera_path + ": " + error.what());
  }
  report->file = request.camera_path;
  report->poses = static_cast<int>(on_clock.poses.size());
  report->interpolated = sampled.interpolated;
  report->beyond = sampled.beyond;
  report->by_sorted_name = path.by_sorted_name;
  return sampled.camera_from_scene;
}

double CameraScaleOf(const SceneRequest& request, const RecordedCameraPath& path) {
  return request.camera_scale_m > 0 ? request.camera_scale_m : path.is_metric ? 1 : 0;
}

std::string ToText(const CameraPathReport& report, const CameraPathSummary& solved) {
  std::string text = report.motion.empty() ? "" : "motion   " + report.motion + "\n";
  if (!report.any()) return text;
  text += Concatenate("path     ", report.poses, " poses of ", report.found ? "the video's background" : report.file,
                      report.by_sorted_name ? ", counted by their sorted names" : "");
  if (report.interpolated > 0) text += Concatenate("; ", report.interpolated, " frames between them");
  if (report.beyond > 0) text += Concatenate("; ", report.beyond, " frames beyond them, taken to stand still");
  if (report.found) text += ", within " + Fixed(report.sigma_deg, 3) + " deg";
  if (report.found && !report.goes) return text + "; it turns in place\n";
  if (report.found) {
    text += Concatenate(" and ", Fixed(100 * report.sigma_place, 1), " % of its way; ", report.background_points,
                        " points in space");
  }
  text += "\nscale    ";
  if (!solved.estimated) return text + Fixed(solved.scale_m, 4) + " m a unit of the path, as given\n";
  if (solved.scale_m == 0) {
    return text + "not found (" + solved.why + "): its rotations alone were used; give --camera-scale\n";
  }
  return text + Fixed(solved.scale_m, 4) + " +- " + Fixed(solved.sigma_m, 4) + " m a unit of the path, from " +
         solved.why + "\n";
}

nlohmann::ordered_json ToJson(const CameraPathReport& report, const CameraPathSummary& solved) {
  return {{"file", report.file},
          {"poses", report.poses},
          {"frames_between", report.interpolated},
          {"frames_beyond", report.beyond},
          {"by_sorted_name", report.by_sorted_name},
          {"scale_m", solved.scale_m},
          {"scale_estimated", solved.estimated},
          {"scale_sigma_m", solved.sigma_m},
          {"scale_from", solved.why},
          {"found", report.found},
          {"motion", report.motion},
          {"turned_deg", report.turned_deg},
          {"rotation_sigma_deg", report.sigma_deg},
          {"goes_from_place_to_place", report.goes},
          {"place_sigma", report.sigma_place},
          {"background_points", report.background_points}};
}

std::string MovingCameraWarning(const CameraPathReport& report, const CameraPathSummary& solved,
                                const GroundSummary& ground) {
  if (solved.moves || report.is_still || !(ground.standing_speed_mps > kStandingStill)) return "";
  return "the camera seems to move: feet that stand move at " + Fixed(ground.standing_speed_mps, 2) +
         " m/s; give its path with --camera-path, without it places and speeds are the camera's too";
}

}  // namespace bodyloom
