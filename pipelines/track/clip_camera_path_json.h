// SPDX-License-Identifier: Apache-2.0
/// What became of a camera's path, for a program.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bodyloom/pipelines/track/clip_camera_path.h"

namespace bodyloom {

/// The report's fields, and the scale and how it was found.
nlohmann::ordered_json ToJson(const CameraPathReport& report, const CameraPathSummary& solved);

}  // namespace bodyloom
