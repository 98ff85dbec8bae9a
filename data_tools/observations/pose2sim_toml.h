// SPDX-License-Identifier: Apache-2.0
/// Converts Pose2Sim's Calib.toml to JSON of this project's cameras (load_cameras.h, form 3).
///
/// One table per camera, in the order of the file: `name` (else the table's own; of [cameras.X] X), `size` [w, h],
/// `matrix` 3×3, `distortions` 4 or 5, `rotation` (Rodrigues, world → camera), `translation` (metres). Tables metadata,
/// capture_volume, charuco and checkerboard are not cameras. Values of other keys may be any TOML values. Source:
/// Pose2Sim common.py, calibration.py.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace bodyloom {

/// Throws std::runtime_error naming `where`, the line, what it holds and what was expected.
nlohmann::json CamerasOfPose2SimToml(const std::string& text, const std::string& where);

}  // namespace bodyloom
