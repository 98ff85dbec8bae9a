// SPDX-License-Identifier: Apache-2.0
/// The config.json that every run folder of a renderer begins with.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace bodyloom {

std::string RunConfigPath(const std::string& run_dir);

/// RUN/config.json of a run of `program`. Throws std::runtime_error naming the file: not there, no JSON, or of another
/// program.
nlohmann::json ReadRunConfig(const std::string& run_dir, const std::string& program);

}  // namespace bodyloom
