// SPDX-License-Identifier: Apache-2.0
/// Writes the clip's camera as a COLMAP text model: a folder with cameras.txt, images.txt and points3D.txt, for
/// reconstruction and splat training.
///
/// One camera: PINHOLE, or FULL_OPENCV where the lens distorts; principal point + 0.5, because COLMAP's origin is the
/// corner of the first pixel. One image "frame_000000.png" … per known frame of the first person's track, all with the
/// same pose if the camera is static: pose world → camera, quaternion w x y z. Points: the vertices of every person's
/// first known frame, as initialisation. World: metres, y up (unlike COLMAP's own reconstructions, whose vertical is
/// arbitrary).
/// Source: colmap doc/format.rst.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "data_tools/export/export_scene.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/world_frame.h"

namespace bodyloom {

/// Lines of cameras.txt and images.txt (the latter with its empty line of points). Throws std::invalid_argument for a
/// camera without image size or of weak perspective.
std::string ColmapCameraLine(int camera_id, const Camera& camera);
std::string ColmapImageLine(size_t image_id, const CameraPose& camera_from_world, int camera_id,
                            const std::string& name);
/// First lines of these files: comments.
std::string ColmapCamerasHeading();
std::string ColmapImagesHeading();
std::string ColmapPointsHeading();

std::string ColmapCamerasText(const Camera& camera);
std::string ColmapImagesText(const ExportScene& scene);
std::string ColmapPointsText(const ExportScene& scene);

/// Throws std::invalid_argument for a camera without image size or of weak perspective, std::runtime_error when a file
/// cannot be written.
void WriteColmap(const std::string& folder, const ExportScene& scene);

// Writes the clip's camera as Pose2Sim's Calib.toml: metres, world with z up. One table: size, matrix (pixels),
// distortions k1 k2 p1 p2, rotation (Rodrigues) and translation world → camera. Its x, y, z are our z, x, y (y up), the
// rotation that its TRC files undo.
// Source: Pose2Sim calibration.py (toml_write).

/// `name`: letters, digits, '_' and '-'. The distortion coefficients k3 … k6, which the format does not support, are
/// left out. Throws std::invalid_argument for another name, no image size, or weak perspective.
std::string Pose2SimCalibrationText(const std::string& name, const Camera& camera, const WorldFrame& world);
/// One camera's table, and the table that ends the file; throws as above.
std::string Pose2SimCameraTable(const std::string& name, const Camera& camera, const CameraPose& camera_from_world);
std::string Pose2SimMetadata();
void WritePose2SimCalibration(const std::string& path, const std::string& name, const Camera& camera,
                              const WorldFrame& world);

// Writes calibrated cameras for other programs, in the frame of the cameras' poses, metres. For a rig
// (geometry/scene/rig.h) this is the frame of its first camera: x right, y down, z forward. Clocks and standard
// deviations have no place in these forms. All functions throw std::invalid_argument without cameras and for a camera
// that is no pinhole with an image size; names must be distinct.

/// Pose2Sim's Calib.toml, as of one camera (above): names of letters, digits, '_' and '-'; distortion k1
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
