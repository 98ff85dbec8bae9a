// SPDX-License-Identifier: Apache-2.0
/// Cameras as JSON, for the files that hold them; apart from load_cameras.h, which users include without the JSON
/// library.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "data_tools/observations/load_cameras.h"

namespace bodyloom {

/// Form 3's list of cameras, each with its pose.
nlohmann::json CamerasToJson(const std::vector<NamedCamera>& cameras);

}  // namespace bodyloom
