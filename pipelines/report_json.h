// SPDX-License-Identifier: Apache-2.0
/// Reports of the jobs as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bodyloom/geometry/base/stopwatch.h"

namespace bodyloom {

/// {"stage": seconds, …}
nlohmann::ordered_json ToJson(const StageSeconds& seconds);

/// Writes a report, whole or not at all; an empty path: none.
void WriteReport(const std::string& path, const nlohmann::ordered_json& report);

}  // namespace bodyloom
