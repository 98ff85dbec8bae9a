// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/angle_writers.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

void CheckSizes(const TrackAngles& angles, const char* form) {
  const auto T = static_cast<Eigen::Index>(angles.timestamps.size());
  BODYLOOM_CHECK(angles.values.rows() == T && angles.values.cols() == kNumCoordinates && angles.sigma_deg.rows() == T &&
                     angles.sigma_deg.cols() == kNumCoordinates,
                 form, ": ", T, " times, values ", angles.values.rows(), "x", angles.values.cols(), " and sigma ",
                 angles.sigma_deg.rows(), "x", angles.sigma_deg.cols(), ", expected ", kNumCoordinates, " columns");
}

/// Nothing for a value that is not finite.
std::string Field(double value, int decimals) {
  if (!std::isfinite(value)) return "";
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace

std::string AnglesCsv(const TrackAngles& angles) {
  CheckSizes(angles, "angles as CSV");
  std::vector<int> with_sigma;
  for (int c = 0; c < kNumCoordinates; ++c) {
    if (angles.sigma_deg.col(c).array().isFinite().any()) with_sigma.push_back(c);
  }
  std::string text = "frame,time";
  for (const std::string& name : CoordinateNames()) text += "," + name;
  for (const int c : with_sigma) text += "," + CoordinateNames()[size_t(c)] + "_sigma";
  text += "\n";
  for (Eigen::Index t = 0; t < angles.values.rows(); ++t) {
    text += std::to_string(t) + "," + Field(angles.timestamps[size_t(t)], 6);
    for (int c = 0; c < kNumCoordinates; ++c) text += "," + Field(angles.values(t, c), IsAngle(c) ? 4 : 6);
    for (const int c : with_sigma) text += "," + Field(angles.sigma_deg(t, c), 4);
    text += "\n";
  }
  return text;
}

std::string AnglesMot(const TrackAngles& angles) {
  CheckSizes(angles, "angles as .mot");
  std::string rows;
  int count = 0;
  for (Eigen::Index t = 0; t < angles.values.rows(); ++t) {
    if (!angles.values.row(t).allFinite()) continue;
    ++count;
    rows += Field(angles.timestamps[size_t(t)], 8);
    for (int c = 0; c < kNumCoordinates; ++c) rows += "\t" + Field(angles.values(t, c), 8);
    rows += "\n";
  }
  BODYLOOM_CHECK(count > 0, "every frame is lost, there is nothing to write");
  std::string text = "Coordinates\nversion=1\nnRows=" + std::to_string(count) +
                     "\nnColumns=" + std::to_string(kNumCoordinates + 1) +
                     "\ninDegrees=yes\n\nUnits are S.I. units (second, meters, Newtons, ...)\n"
                     "If the header above contains a line with 'inDegrees', this indicates whether rotational values "
                     "are in degrees (yes) or radians (no).\n\nendheader\ntime";
  for (const std::string& name : CoordinateNames()) text += "\t" + name;
  return text + "\n" + rows;
}

std::string GaitJson(const GaitReport& gait) {
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
  };
  nlohmann::ordered_json json = {{"walks", gait.walks}};
  if (!gait.walks) json["reason"] = gait.reason;
  json["num_steps"] = gait.num_steps;
  json["cadence_per_min"] = number(gait.cadence_per_min);
  json["step_time_s"] = number(gait.step_time_s);
  json["step_length_m"] = {{"left", number(gait.step_length_m[0])}, {"right", number(gait.step_length_m[1])}};
  json["speed_mps"] = number(gait.speed_mps);
  json["bouts_s"] = nlohmann::ordered_json::array();
  for (const auto& [first, last] : gait.bouts_s) json["bouts_s"].push_back({first, last});
  json["events"] = nlohmann::ordered_json::array();
  for (const GaitEvent& event : gait.events) {
    json["events"].push_back({{"time_s", event.seconds},
                              {"frame", event.frame},
                              {"foot", event.foot == Foot::kLeft ? "left" : "right"},
                              {"event", event.kind == GaitEventKind::kFootStrike ? "foot_strike" : "foot_off"}});
  }
  return json.dump(2) + "\n";
}

}  // namespace bodyloom
