// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "pipelines/report_json.h"
#include "pipelines/report_text.h"
#include "pipelines/track/clip_camera_path.h"

namespace bodyloom {
namespace {

using Json = nlohmann::ordered_json;

std::string MedianText(const MedianAndP95& of, int digits, const std::string& unit) {
  return Fixed(of.median, digits) + unit + " (95 % below " + Fixed(of.p95, digits) + ")";
}

std::string ToText(const InitialiserReport& from, int num_frames) {
  const InitialiserGain& gain = from.gain;
  std::string text = "start    " + from.system + ", person " + from.person +
                     (from.people > 1 ? " of " + std::to_string(from.people) : "") + ", " +
                     std::to_string(from.frames) + " of " + std::to_string(num_frames) + " frames";
  if (from.gives_landmarks) {
    text += "; 3D landmarks alone\nmoved    landmarks by " + MedianText(gain.joint_mm, 0, " mm") + " about the hips\n";
  } else {
    text += std::string(from.has_shape ? "" : "; its shape is another body's and left out") + "\nmoved    joints by " +
            MedianText(gain.joint_mm, 0, " mm") + " about the pelvis, turned by " +
            MedianText(gain.rotation_deg, 1, " deg") + ", root by " + MedianText(gain.root_deg, 1, " deg") + "\n";
  }
  if (gain.landmarks > 0) {
    text += "gain     2D joints: " + MedianText(gain.initialiser_px, 2, " px") + " of the start, " +
            MedianText(gain.fit_px, 2, " px") + " of the fit\n";
  }
  return text;
}

Json ToJson(const InitialiserReport& from) {
  const InitialiserGain& gain = from.gain;
  Json json = {{"system", from.system},         {"person", from.person},
               {"people", from.people},         {"frames", from.frames},
               {"has_shape", from.has_shape},   {"gives_landmarks", from.gives_landmarks},
               {"compared_frames", gain.frames}};
  const auto add = [&](const std::string& name, const std::string& unit, const MedianAndP95& of) {
    json[name + "_median_" + unit] = of.median;
    json[name + "_p95_" + unit] = of.p95;
  };
  add("joint", "mm", gain.joint_mm);
  add("root", "mm", gain.root_mm);
  add("rotation", "deg", gain.rotation_deg);
  add("root", "deg", gain.root_deg);
  json["landmarks"] = gain.landmarks;
  add("initialiser", "px", gain.initialiser_px);
  add("fit", "px", gain.fit_px);
  return json;
}

/// "2D joints 41 %, smoothness 22 %, …": the largest five.
std::string CostsText(const std::vector<TermCost>& costs) {
  constexpr size_t kShown = 5;
  double sum = 0;
  for (const TermCost& cost : costs) sum += cost.cost;
  std::string text;
  for (size_t i = 0; i < std::min(kShown, costs.size()) && sum > 0; ++i) {
    text += (i == 0 ? "" : ", ") + costs[i].term + " " + Fixed(100 * costs[i].cost / sum, 0) + " %";
  }
  return text;
}

Json ToJson(const WorstStretch& worst) {
  return {{"begin_frame", worst.begin},    {"end_frame", worst.end},         {"begin_s", worst.begin_s},
          {"end_s", worst.end_s},          {"cost_ratio", worst.cost_ratio}, {"term", worst.term},
          {"term_share", worst.term_share}};
}

}  // namespace

StageSeconds StagesOf(const TrackReport& report) {
  StageSeconds all;
  for (const auto& [stage, seconds] : report.seconds) {
    if (stage != kSolveStage || report.solve.seconds.empty()) {
      all.emplace_back(stage, seconds);
      continue;
    }
    double rest = seconds;
    for (const auto& [solver_stage, solver_seconds] : report.solve.seconds) {
      all.emplace_back(solver_stage, solver_seconds);
      rest -= solver_seconds;
    }
    all.emplace_back("solve, other", std::max(0.0, rest));
  }
  return all;
}

std::string ToText(const std::vector<PlanEntry>& plan) {
  size_t width = 0;
  for (const PlanEntry& entry : plan) {
    width = std::max(width, entry.what.size());
  }
  std::string text;
  for (const PlanEntry& entry : plan) {
    text += std::string(entry.runs ? "  run   " : "  skip  ") + entry.what +
            std::string(width - entry.what.size() + 2, ' ') + entry.why + "\n";
  }
  return text;
}

std::string FocalSigmaText(double focal_log_sigma) {
  if (!(focal_log_sigma > 0)) return "";
  return ", estimated within " + Fixed(100 * focal_log_sigma, 1) + " % (standard deviation)";
}

std::string FittedPartsText(const TrackSequenceSummary& summary) {
  std::string text;
  const auto add = [&text](const std::string& what, const PartFitSummary& part) {
    text += "         " + what + " " + (part.ran ? "" : "not fitted: ") + part.why;
    if (part.median_px > 0) text += "; median " + Fixed(part.median_px, 2) + " px";
    text += "\n";
  };
  if (summary.hands.size() == 2) {
    add("left hand", summary.hands[0]);
    add("right hand", summary.hands[1]);
  }
  if (summary.head) add("head", *summary.head);
  return text;
}

std::string ToText(const TrackReport& report) {
  const TrackSequenceSummary& solve = report.solve;
  std::string text = std::to_string(report.num_frames) + " frames: ";
  const std::string counts = solve.FramesReport();
  text += (counts.empty() ? "none estimated" : counts) + "\n";
  text += "solve    " + ToString(solve.status) + ", " + solve.solver + ", " + std::to_string(solve.iterations) +
          " iterations" +
          (solve.initial_cost > 0 ? ", cost " + Fixed(solve.initial_cost, 1) + " -> " + Fixed(solve.final_cost, 1)
                                  : std::string()) +
          (solve.message.empty() ? "" : " (" + solve.message + ")") + "\n";
  if (solve.ceres.ran) {
    text += "ceres    " + std::to_string(solve.ceres.iterations) + " iterations in " + Fixed(solve.ceres.seconds, 2) +
            " s, cost " + Fixed(solve.ceres.initial_cost, 2) + " -> " + Fixed(solve.ceres.final_cost, 2) +
            ", gradient below " + Fixed(solve.ceres.gradient_max_norm, 3) + "\n";
  }
  if (!solve.costs.empty()) text += "costs    " + CostsText(solve.costs) + "\n";
  if (solve.worst_stretch) text += "worst    " + solve.worst_stretch->BriefReport() + "\n";
  text += "error    2D joints: median " + Fixed(solve.reprojection_median_px, 2) + " px, 95 % below " +
          Fixed(solve.reprojection_p95_px, 2) + " px";
  if (solve.dense_median_px > 0) {
    text += "; dense keypoints: median " + Fixed(solve.dense_median_px, 2) + " px";
  }
  text += "\n";
  text += FittedPartsText(solve);
  if (report.initialiser && solve.IsUsable()) text += ToText(*report.initialiser, report.num_frames);
  if (solve.focal_px > 0) {
    text += "camera   focal length " + Fixed(solve.focal_px, 1) + " px" + FocalSigmaText(solve.focal_log_sigma) + "\n";
  }
  text += ToText(report.views);
  text += ToText(report.camera_path, solve.camera_path);
  if (solve.num_swaps_repaired > 0) {
    text += "repaired " + std::to_string(solve.num_swaps_repaired) + " left-right swaps in the detections\n";
  }
  if (solve.ground.has_plane) {
    text += "ground   " + Fixed(solve.ground.camera_height_m, 2) + " m below the camera";
    if (solve.ground.contact_frames > 0) {
      text += ", feet held in " + std::to_string(solve.ground.contact_frames) + " frames";
    }
    text += " (" + solve.ground.why + ")\n";
  } else if (!solve.ground.why.empty()) {
    text += "ground   none: " + solve.ground.why + "\n";
  }
  if (solve.IsUsable()) text += "world    " + report.world.BriefReport() + "\n";
  if (report.room.frames > 0) text += "room     " + report.room.BriefReport() + "\n";
  if (solve.flights.flights > 0) text += "jumps    " + solve.flights.BriefReport() + "\n";
  text += "time     " + Fixed(report.total_seconds, 2) + " s (" + StagesText(StagesOf(report)) + ")";
  if (report.num_frames > 0 && report.total_seconds > 0) {
    text += ", " + Fixed(1e3 * report.total_seconds / report.num_frames, 2) + " ms a frame";
  }
  text += "\nmemory   " + Fixed(static_cast<double>(report.peak_memory_bytes) / (1 << 20), 0) + " MiB at most\n";
  for (const PlanEntry& entry : solve.plan) {
    if (!entry.runs) {
      text += "skipped  " + entry.what + ": " + entry.why + "\n";
    }
  }
  for (const std::string& output : report.outputs) {
    text += "wrote    " + output + "\n";
  }
  return text;
}

std::string ToJson(const TrackReport& report) {
  const TrackSequenceSummary& solve = report.solve;
  Json seconds = Json::object();
  for (const auto& [stage, value] : StagesOf(report)) {
    seconds[stage] = seconds.value(stage, 0.0) + value;
  }
  seconds["total"] = report.total_seconds;
  Json skipped = Json::array(), ran = Json::array();
  for (const PlanEntry& entry : solve.plan) {
    (entry.runs ? ran : skipped).push_back({{"what", entry.what}, {"why", entry.why}});
  }
  const GroundSummary& ground = solve.ground;
  Json ground_json = {{"found", ground.has_plane}, {"why", ground.why}, {"contact_frames", ground.contact_frames}};
  if (ground.has_up) {
    ground_json["up_in_camera"] = {ground.up.x(), ground.up.y(), ground.up.z()};
    ground_json["up_spread_deg"] = ground.up_spread_deg;
  }
  ground_json["standing_speed_mps"] = ground.standing_speed_mps;
  if (ground.has_plane) {
    ground_json["camera_height_m"] = ground.camera_height_m;
    ground_json["height_spread_m"] = ground.height_spread_m;
  }
  Json json = {
      {"status", ToString(solve.status)},
      {"message", solve.message},
      {"detections", report.detections},
      {"frames", report.num_frames},
      {"frames_by_status", solve.frames_by_status},
      {"lost_in_holes", solve.lost_in_holes},
      {"solver", solve.solver},
      {"iterations", solve.iterations},
      {"initial_cost", solve.initial_cost},
      {"final_cost", solve.final_cost},
      {"observations", solve.num_observations},
      {"parameters", solve.num_parameters},
      {"reprojection_median_px", solve.reprojection_median_px},
      {"reprojection_p95_px", solve.reprojection_p95_px},
      {"dense_median_px", solve.dense_median_px},
      {"focal_px", solve.focal_px},
      {"focal_log_sigma", solve.focal_log_sigma},
      {"swaps_repaired", solve.num_swaps_repaired},
      {"ground", ground_json},
      {"world", ToJson(report.world)},
      {"room", ToJson(report.room)},
      {"seconds", seconds},
      {"peak_memory_bytes", report.peak_memory_bytes},
      {"ran", ran},
      {"skipped", skipped},
      {"outputs", report.outputs},
  };
  if (solve.ceres.ran) {
    json["ceres"] = {{"iterations", solve.ceres.iterations},
                     {"initial_cost", solve.ceres.initial_cost},
                     {"final_cost", solve.ceres.final_cost},
                     {"gradient_max_norm", solve.ceres.gradient_max_norm},
                     {"seconds", solve.ceres.seconds}};
  }
  for (const TermCost& cost : solve.costs) json["cost_by_term"][cost.term] = cost.cost;
  if (solve.worst_stretch) json["worst_stretch"] = ToJson(*solve.worst_stretch);
  if (report.camera_path.any() || !report.camera_path.motion.empty())
    json["camera_path"] = ToJson(report.camera_path, solve.camera_path);
  for (const ViewReport& view : report.views) json["views"].push_back(ToJson(view));
  AddJumps(solve.flights, &json);
  AddFittedParts(solve, &json);
  if (report.initialiser) json["initialiser"] = ToJson(*report.initialiser);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bodyloom
