// SPDX-License-Identifier: Apache-2.0
#include "pipelines/live/live_state.h"

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>

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

}  // namespace bodyloom
