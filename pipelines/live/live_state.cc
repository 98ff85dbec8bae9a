// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/live_state.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <nlohmann/json.hpp>

#include "pipelines/report_text.h"

namespace bodyloom {
namespace {

nlohmann::ordered_json Rounded(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(std::round(value * 1e5) / 1e5) : nlohmann::ordered_json();
}

nlohmann::ordered_json RoundedList(const Eigen::Ref<const Eigen::VectorXd>& values) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const double value : values) list.push_back(Rounded(value));
  return list;
}

nlohmann::ordered_json RowsOfMatrix(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) rows.push_back(RoundedList(matrix.row(row).transpose()));
  return rows;
}

}  // namespace

std::string LiveJson(const LiveState& state) {
  const LiveFrame& frame = state.frame;
  nlohmann::ordered_json json;
  json["frame"] = frame.index;
  json["seconds"] = Rounded(frame.timestamp);
  json["status"] = ToString(frame.status);
  json["cut"] = frame.cut_before;
  json["delay_ms"] = std::round(10 * state.delay_ms) / 10;
  json["dropped"] = state.dropped;
  for (const char* name : {"poses", "trans", "betas", "joints", "joint_sigma"}) json[name] = nullptr;
  if (state.HasPose()) {
    json["poses"] = RoundedList(AxisAngleFromPose(*state.body, state.pose));
    json["trans"] = RoundedList(state.pose.trans);
    json["betas"] = RoundedList(frame.betas);
    json["joints"] = RowsOfMatrix(state.joints);
    json["joint_sigma"] = RoundedList(frame.joint_sigma);
  }
  const Camera& camera = frame.camera;
  json["camera"] = {{"width", camera.width},    {"height", camera.height},  {"fx", Rounded(camera.fx)},
                    {"fy", Rounded(camera.fy)}, {"cx", Rounded(camera.cx)}, {"cy", Rounded(camera.cy)}};
  json["world"] = {{"rotation", RowsOfMatrix(state.world.rotation)},
                   {"translation", RoundedList(state.world.translation)},
                   {"source", ToString(state.world.source)},
                   {"vertical_sigma_deg", Rounded(state.world.vertical_sigma_deg)},
                   {"height_sigma_m", Rounded(state.world.height_sigma_m)}};
  return json.dump();
}

void DelayCounts::Add(double milliseconds) {
  const auto bin = size_t(std::clamp(milliseconds, 0.0, double(counts_.size() - 1)));
  ++counts_[bin];
  ++total_;
  most_ = std::max(most_, milliseconds);
}

double DelayCounts::At(double share) const {
  if (total_ == 0) return std::numeric_limits<double>::quiet_NaN();
  int64_t below = 0;
  for (size_t bin = 0; bin < counts_.size(); ++bin) {
    below += counts_[bin];
    if (double(below) >= share * double(total_)) return double(bin) + 0.5;
  }
  return most_;
}

std::string ToText(const DelayPercentiles& delay) {
  return Fixed(delay.median, 0) + " ms in half of the frames, " + Fixed(delay.p95, 0) + " in 95 %, " +
         Fixed(delay.p99, 0) + " in 99 %, " + Fixed(delay.most, 0) + " at most";
}

}  // namespace bodyloom
