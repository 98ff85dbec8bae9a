// SPDX-License-Identifier: Apache-2.0
/// Pose2Sim's Calib.toml as JSON of this project's cameras (load_cameras.h, form 3).
///
/// A table a camera, in the order of the file: `name` (else the table's own; of [cameras.X] X), `size` [w, h], `matrix`
/// 3×3, `distortions` 4 or 5, `rotation` (Rodrigues, world → camera), `translation` (metres). Tables metadata,
/// capture_volume, charuco and checkerboard are no cameras. Values of other keys may be anything that TOML knows.
/// Source: Pose2Sim common.py, calibration.py.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace bodyloom {

/// Throws std::runtime_error naming `where`, the line, what it holds and what was expected.
nlohmann::json CamerasOfPose2SimToml(const std::string& text, const std::string& where);

}  // namespace bodyloom
