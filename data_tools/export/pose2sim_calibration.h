// SPDX-License-Identifier: Apache-2.0
/// The clip's camera as Pose2Sim's Calib.toml: metres, world with z up. One table: size, matrix (pixels), distortions
/// k1 k2 p1 p2, rotation (Rodrigues) and translation world → camera. Its x, y, z are our z, x, y
/// (y up), the turn that its TRC files undo.
/// Source: Pose2Sim calibration.py (toml_write).
#pragma once

#include <string>

#include "bodyloom/geometry/camera.h"
#include "bodyloom/geometry/world_frame.h"

namespace bodyloom {

/// `name`: letters, digits, '_' and '-'. The further distortion coefficients k3 … k6, which the format has no place for,
/// are left out. Throws std::invalid_argument for another name, no image size, or weak perspective.
std::string Pose2SimCalibrationText(const std::string& name, const Camera& camera, const WorldFrame& world);
void WritePose2SimCalibration(const std::string& path, const std::string& name, const Camera& camera,
                              const WorldFrame& world);

}  // namespace bodyloom
