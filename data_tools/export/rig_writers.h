// SPDX-License-Identifier: Apache-2.0
/// Writes calibrated cameras for other programs, in the frame of the cameras' poses, metres. For a rig
/// (geometry/scene/rig.h) this is the frame of its first camera: x right, y down, z forward. Clocks and standard
/// deviations have no place in these forms. All functions throw std::invalid_argument without cameras and for a camera
/// that is no pinhole with an image size; names must be distinct.
#pragma once

#include <string>
#include <vector>

#include "data_tools/observations/load_cameras.h"

namespace bodyloom {

/// Pose2Sim's Calib.toml, as camera_writers.h writes one camera: names of letters, digits, '_' and '-'; distortion k1
/// k2 p1 p2. Throws std::invalid_argument for a camera with further coefficients, which the form does not hold.
std::string Pose2SimRigText(const std::vector<NamedCamera>& cameras);

/// YAML of cv::FileStorage: a list `cameras` of maps with
///   name                      text
///   image_width, image_height  pixels
///   camera_matrix             3×3
///   distortion_coefficients   1×5 (k1 k2 p1 p2 k3), or 1×8 with k4 k5 k6
///   rotation, translation     3×3, 3×1: camera from world
std::string OpenCvRigText(const std::vector<NamedCamera>& cameras);

/// A COLMAP text model: a folder with cameras.txt (PINHOLE, or FULL_OPENCV where the lens distorts), images.txt (one
/// image NAME.png a camera) and points3D.txt without points. Image i has camera i, from 1. Throws std::runtime_error
/// when a file cannot be written.
void WriteColmapRig(const std::string& folder, const std::vector<NamedCamera>& cameras);

}  // namespace bodyloom
