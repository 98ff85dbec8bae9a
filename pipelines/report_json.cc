// SPDX-License-Identifier: Apache-2.0
#include "pipelines/report_json.h"

#include <nlohmann/json.hpp>

#include "data_tools/formats/atomic_file.h"

namespace bodyloom {

nlohmann::ordered_json ToJson(const StageSeconds& seconds) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const auto& [stage, stage_s] : seconds) stages[stage] = stage_s;
  return stages;
}

nlohmann::ordered_json ToJson(const WorldFrame& world) {
  nlohmann::ordered_json matrix = nlohmann::ordered_json::array();
  for (int r = 0; r < 3; ++r) {
    matrix.push_back({world.rotation(r, 0), world.rotation(r, 1), world.rotation(r, 2), world.translation[r]});
  }
  matrix.push_back({0, 0, 0, 1});
  return {{"source", ToString(world.source)},
          {"vertical_sigma_deg", world.vertical_sigma_deg},
          {"height_sigma_m", world.height_sigma_m},
          {"camera_height_m", world.camera_height_m()},
          {"world_from_camera", matrix}};
}

nlohmann::ordered_json ToJson(const RoomPhysics& room) {
  if (room.frames == 0) return nullptr;
  Evaluation values;
  AddRoomPhysics(room, &values);
  nlohmann::ordered_json json = {{"frames", room.frames}};
  for (const EvaluationValue& value : values.values) json[value.name] = value.value;
  return json;
}

void AddJumps(const FlightSummary& flights, nlohmann::ordered_json* report) {
  if (flights.flights == 0) return;
  (*report)["jumps"] = {{"flights", flights.flights},
                        {"stature_m", flights.stature_m},
                        {"sigma_m", flights.sigma_m},
                        {"assumed_m", flights.assumed_m}};
}

void AddHandsAndFaces(const HandsAndFaceSummary& summary, nlohmann::ordered_json* report) {
  if (!summary.why_not.empty()) (*report)["hands_not_looked_for"] = summary.why_not;
  if (summary.hands.parts == 0) return;
  const auto counts = [](const PartCounts& n) {
    return nlohmann::ordered_json{{"looked_for", n.parts}, {"found", n.found},     {"hidden", n.hidden},
                                  {"too_small", n.small},  {"not_seen", n.absent}, {"at_other_hand", n.elsewhere}};
  };
  (*report)["hands"] = counts(summary.hands);
  (*report)["faces"] = counts(summary.faces);
  (*report)["hands_and_faces_seconds"] = summary.seconds;
}

void AddFittedParts(const TrackSequenceSummary& summary, nlohmann::ordered_json* report) {
  const auto add = [&](const char* what, const PartFitSummary& part) {
    (*report)[what] = {{"fitted", part.ran},
                       {"why", part.why},
                       {"frames_seen", part.frames_seen},
                       {"iterations", part.iterations},
                       {"median_px", part.median_px},
                       {"size", part.size}};
  };
  if (summary.hands.size() == 2) {
    add("left_hand", summary.hands[0]);
    add("right_hand", summary.hands[1]);
  }
  if (summary.head) add("head", *summary.head);
}

void WriteReport(const std::string& path, const nlohmann::ordered_json& report) {
  if (!path.empty()) WriteFileAtomically(path, report.dump(2) + "\n");
}

}  // namespace bodyloom
