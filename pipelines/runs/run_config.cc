// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/runs/run_config.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bodyloom/data_tools/formats/json_reader.h"

namespace bodyloom {

std::string RunConfigPath(const std::string& run_dir) {
  return (std::filesystem::path(run_dir) / "config.json").string();
}

nlohmann::json ReadRunConfig(const std::string& run_dir, const std::string& program) {
  const std::string path = RunConfigPath(run_dir);
  if (!std::filesystem::exists(path)) {
    throw std::runtime_error(path + ": not there, expected the folder of a run of `" + program + "`");
  }
  nlohmann::json json = ReadJsonFile(path);
  const std::string found = JsonNode(json, path).At("program").Text();
  if (found != program) throw std::runtime_error(path + ": a run of \"" + found + "\", expected \"" + program + "\"");
  return json;
}

}  // namespace bodyloom
