// SPDX-License-Identifier: Apache-2.0
/// Loads the path of a moving camera from files.
///
/// 1. COLMAP (colmap_reader.h): a folder with images.bin or images.txt, or such a file. Its images are the clip's
///    frames by the last number in their names ("frame_000012.png": 12), or by their sorted names where names have no
///    number or two the same. Its scale is unknown.
/// 2. This project's JSON:
///      "camera_path"  1, the form's version
///      "metric"       optional, true: translations are metres; false: their unit is not known
///      "fps"          optional rate of the frame numbers below; without it they are the clip's frames
///      "frames"       a list, in increasing order, of
///        "frame"        a whole number from 0, or "time": seconds on the clip's clock (one kind in a file)
///        "rotation"     camera from world: 3×3, or Rodrigues 3, radians;  or  "quaternion" [w, x, y, z]
///        "translation"  camera from world, 3
///      "camera"       optional intrinsics, as in load_cameras.h's form 3 (without a pose)
///    camera from world: x_camera = R x_world + t, camera axes x right, y down, z forward; the world may be any
///    static frame.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/scene/camera.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom {

struct RecordedCameraPath {
  std::vector<CameraPose> poses;  ///< N ≥ 1, camera from world
  std::vector<int> frames;        ///< N, increasing: their frames; empty: see `seconds`
  std::vector<double> seconds;    ///< N, increasing; or empty
  double fps = 0;                 ///< of `frames`; 0: they are the clip's own
  bool is_metric = true;          ///< translations are metres
  bool is_colmap = false;
  std::optional<Camera> camera;  ///< intrinsics, if the file has those of a pinhole
  std::string why_no_camera;     ///< reason if there are none
  bool by_sorted_name = false;   ///< frames were numbered in order, as the images' names have no numbers
};

/// Throws std::runtime_error naming file and place: what was found, what was expected.
RecordedCameraPath LoadCameraPath(const std::string& path);

/// Form 2 from a text; `where` names it in messages.
RecordedCameraPath CameraPathFromText(const std::string& text, const std::string& where);

/// Writes form 2 with times.
void WriteCameraPath(const std::string& path, const CameraPath& camera_path, bool is_metric = true);

struct PlaceInTime {
  int first = -1;  ///< number of the clip's first frame; −1: 0 if the path begins with 0, else 1 for COLMAP, 0 for JSON
  double fps = 0;  ///< rate of numbered frames; 0: the file's, or else they are the clip's frames
};
/// Converts the path to the clock of a clip with frames at these seconds: numbered frames take the times of the clip's
/// frames, and those beyond its end are left out. Throws std::runtime_error beginning with `where` if none is in the
/// clip.
CameraPath CameraPathOnClock(const RecordedCameraPath& recorded, std::span<const double> clip_seconds,
                             const PlaceInTime& place, const std::string& where);

}  // namespace bodyloom
