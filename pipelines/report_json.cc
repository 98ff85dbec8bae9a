// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/report_json.h"

#include <nlohmann/json.hpp>

#include "bodyloom/data_tools/formats/atomic_file.h"

namespace bodyloom {

nlohmann::ordered_json ToJson(const StageSeconds& seconds) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const auto& [stage, stage_s] : seconds) stages[stage] = stage_s;
  return stages;
}

void WriteReport(const std::string& path, const nlohmann::ordered_json& report) {
  if (!path.empty()) WriteFileAtomically(path, report.dump(2) + "\n");
}

}  // namespace bodyloom
