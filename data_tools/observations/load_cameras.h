// SPDX-License-Identifier: Apache-2.0
/// Loads calibrated cameras, with their poses in metres.
///
/// 1. AIST++: a folder with `mapping.txt` ("<sequence> <setting>" per line) and `<setting>.json`, or such a JSON file:
/// a
///    list of {name, size [w,h], matrix 3×3, distortions, rotation (Rodrigues, rad), translation (cm)}.
/// 2. Pose2Sim `calib_refined.json`: {"cameras": [{name, size [w,h], K 3×3, dist_k1k2p1p2, rvec, tvec_m}]}; beside it
///    `video_to_calib_affine.json` (or the folder that holds both) maps the video's pixels to the
///    calibration's.
///    A Calib.toml (pose2sim_toml.h) is read too.
/// 3. This project's: one object, a list of them, or {"cameras": […]}, each with
///      "model"      "pinhole" (default) or "weak"
///      "width", "height"                    pixels
///      "fx","fy","cx","cy"  or  "K" 3×3     pixels, pinhole; cx, cy default to the image centre, fy to fx
///      "distortion" 4, 5 or 8 numbers       OpenCV order k1 k2 p1 p2 [k3 [k4 k5 k6]], optional
///      "scale","tx","ty"                    weak perspective: pixels a metre, metres
///      "rotation" 3×3 or Rodrigues 3, "translation" 3 metres: camera from world, optional
///      "name"                               optional
///    Of a rig's file (rig_io.h) the cameras are read.
/// 4. Human3.6M's Human36M_subject*_camera.json, an object of "1" to "4", each {R 3×3, t 3 mm, f 2, c 2 pixels}. Images
///    of 1 and 4 have 1000×1002 pixels, of 2 and 3 1000×1000; there is no distortion. t is the camera's centre in older
///    files and the translation in newer ones: it is the one by which the world's origin, the middle of the room, lies
///    in the image.
/// Source: google/aistplusplus_api loader.py (1); mks0601/3DMPPE_POSENET_RELEASE, tool/Human36M/h36m2coco.py and
/// common/utils/pose_utils.py of its versions, facebookresearch/VideoPose3D, common/h36m_dataset.py (4).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/scene/camera.h"

namespace bodyloom {

class JsonNode;

struct NamedCamera {
  std::string name;
  Camera camera;
  CameraPose pose;
  bool has_pose = false;  ///< the file has the pose; else it is the identity
  /// Affine map from this camera's pixels to those of its video (identity unless given in the file).
  Matrix2x3d video_px_from_camera_px = (Matrix2x3d() << 1, 0, 0, 0, 1, 0).finished();
};

/// All cameras of a file or folder; `sequence` picks the setting of an AIST++ folder (the name of the clip or of one of
/// its videos, with or without path and extension). Throws std::runtime_error naming file, place and what was expected.
std::vector<NamedCamera> LoadCameras(const std::string& path, const std::string& sequence = "");

/// The cameras of one file's text; `where` names it in messages.
std::vector<NamedCamera> CamerasFromText(const std::string& text, const std::string& where);

/// The same of a parsed file.
std::vector<NamedCamera> CamerasFromJson(const JsonNode& document);

/// Reads one camera of form 3 without its pose, and a pose ("rotation" 3×3 or Rodrigues 3, "translation" 3 metres) of
/// other JSON.
Camera CameraFromJson(const JsonNode& node);
CameraPose PoseFromJson(const JsonNode& rotation, const JsonNode& translation);

/// The camera called `view` ("c01"; "cam01" also finds "cam_01"); an empty view means the only one. Throws
/// std::runtime_error beginning with `where` and listing the cameras present.
const NamedCamera& FindCamera(const std::vector<NamedCamera>& cameras, const std::string& view,
                              const std::string& where);

/// Writes form 3 with a list of cameras.
void WriteCameras(const std::string& path, const std::vector<NamedCamera>& cameras);

}  // namespace bodyloom
