// SPDX-License-Identifier: Apache-2.0
/// The file of a rig (geometry/scene/rig.h), rig.json: form 3 of load_cameras.h, which LoadCameras() reads, with
///   "rig"        1, the form's version
///   "cameras"    a list of cameras, the first of which defines frame and clock, each with the keys of form 3 (its pose
///                required: camera from rig) and
///     "offset_s", "rate", "middle_s"             the clock: seconds, without unit, seconds; a clock without an offset
///                                                is not known, rate and middle default to 0
///     "rotation_sigma_rad", "translation_sigma_m", "focal_log_sigma", "offset_sigma_s", "rate_sigma"
///                                                standard deviations; 0: given; null or missing: not known
#pragma once

#include <string>
#include <vector>

#include "geometry/scene/rig.h"

namespace bodyloom {

/// Throws std::invalid_argument for a rig without cameras or a camera that is no pinhole with an image size, and
/// std::runtime_error if the file cannot be written.
void WriteRig(const std::string& path, const std::vector<RigCamera>& rig);

/// Throws std::runtime_error naming file, place and what was expected.
std::vector<RigCamera> ReadRig(const std::string& path);

/// The same of a text; `where` names it in messages.
std::vector<RigCamera> RigFromText(const std::string& text, const std::string& where);

/// True for a JSON file with the key "rig"; false for other files and folders of cameras. Throws std::runtime_error for
/// a .json that cannot be read.
bool IsRigFile(const std::string& path);

}  // namespace bodyloom
