// SPDX-License-Identifier: Apache-2.0
/// Writes tracks as a video of projected bodies over the frames they were fitted to.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/observations/load_cameras.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"
#include "render/view/people_overlay.h"
#include "tracking/room/shared_scene.h"

namespace bodyloom {

struct OverlayVideo {
  // Pointers are borrowed; those marked so may be null.
  const BodyModel* body = nullptr;
  const Track* track = nullptr;
  const Track* reference = nullptr;  ///< may be null: the true track, drawn beside the estimate in the side view
  const KeypointSequence* detected = nullptr;  ///< may be null
  std::string video;                           ///< frames to draw on; empty: a plain backdrop
  int video_offset = 0;                        ///< video frame of the track's time zero
  Matrix2x3d video_px_from_camera_px = NamedCamera().video_px_from_camera_px;
  bool side_view = false;
  std::function<void(double fraction)> progress = [](double) {};
};

struct OverlaySummary {
  int frames = 0, frames_without_video = 0;
  std::string video_warning;  ///< VideoReader::warning() of the video below; "" when nothing was wrong
};

/// Draws frame t of the track over the video frame at its timestamp. After the end of the video a plain backdrop is
/// used; these frames are counted. Throws std::runtime_error when the video's size matches neither the camera nor a
/// scaled copy of it, and when `path` cannot be written; no file is left then.
OverlaySummary WriteOverlayVideo(const std::string& path, const OverlayVideo& what);

/// Several people in one picture (render/view/people_overlay.h).
struct PeopleOverlayVideo {
  std::vector<PersonInOverlay> people;
  // As above.
  std::string video;
  Matrix2x3d video_px_from_camera_px = NamedCamera().video_px_from_camera_px;
  bool side_view = false;
  Eigen::Vector3d up_in_camera = -Eigen::Vector3d::UnitY();
  std::optional<Floor> ground;  ///< none: just below the lowest joint
  std::function<void(double fraction)> progress = [](double) {};
};

/// Draws with the scene's vertical and ground, as a camera sees them that stands at `camera_from_scene`.
void SetScene(const SharedScene& scene, const CameraPose& camera_from_scene, PeopleOverlayVideo* overlay);

/// Draws one picture per moment at which somebody is tracked. Throws as WriteOverlayVideo() and PeopleOverlay.
OverlaySummary WritePeopleOverlayVideo(const std::string& path, const PeopleOverlayVideo& what);

}  // namespace bodyloom
