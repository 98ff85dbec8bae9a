// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/descriptors/descriptor_header.h"

#include <nlohmann/json.hpp>

namespace bodyloom {
namespace {

using Json = nlohmann::ordered_json;

Json Rows(const Eigen::Matrix3d& m) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r) rows.push_back({m(r, 0), m(r, 1), m(r, 2)});
  return rows;
}

}  // namespace

std::string DescriptorHeaderJson(const BodyModel& body, const Track& track, const DescribeTrackOptions& options,
                                 const DescribeTrackSummary& summary, const std::vector<int>& outputs) {
  const UvTexelTable& texels = summary.texels;
  Json channels = Json::array();
  if (options.normals) channels = {"normal.x", "normal.y", "normal.z"};
  for (int k = 0; k < options.past; ++k) {
    for (const char axis : {'x', 'y', 'z'}) {
      channels.push_back("velocity[t" + (k > 0 ? "-" + std::to_string(k) : std::string()) + "]." + axis);
    }
  }
  Json times = Json::array(), status = Json::array();
  for (const int t : outputs) {
    times.push_back(track.motion.timestamps[t]);
    status.push_back(ToString(track.frame_status[t]));
  }
  Json velocity = {{"scheme", VelocityName(options)},
                   {"unit", "m/s"},
                   {"past", options.past},
                   {"before_the_first_frame_of_a_run", 0},
                   {"noise_gain_median", summary.noise_gain},
                   {"runs_without_gap", summary.runs},
                   {"frames_without_velocity", summary.frames_without_velocity}};
  if (options.velocity.scheme == VelocityScheme::kSavitzkyGolay) {
    velocity["window_s"] = options.velocity.window_s;
    velocity["order"] = options.velocity.order;
  }
  Json json = {
      {"format", "bodyloom descriptors 1"},
      {"shape", {summary.frames, summary.channels, texels.height, texels.width}},
      {"dtype", options.half ? "float16" : "float32"},
      {"channels", channels},
      {"frame", ToString(options.frame)},
      {"normal", {{"unit", "1"}, {"weighting", options.weighting == NormalWeighting::kArea ? "area" : "angle"}}},
      {"velocity", velocity},
      {"body", body.name()},
      {"track_frames", outputs},
      {"timestamps", times},
      {"frame_status", status},
      {"frames_without_fit", summary.frames_without_fit},
      {"seen_only", options.seen_only},
      {"uv",
       {{"texel_centre", "u = (column + 0.5) / width, v = 1 - (row + 0.5) / height"},
        {"coverage", texels.Coverage()},
        {"texels_inside", texels.num_inside},
        {"texels_in_gutter", texels.num_gutter},
        {"charts", texels.num_charts},
        {"texels_overlapping", texels.overlapping},
        {"texels_contested", texels.contested},
        {"faces_without_area", texels.faces_without_area},
        {"faces_outside", texels.faces_outside}}},
      {"normal_fallbacks",
       {{"degenerate_faces", summary.normals.degenerate_faces},
        {"vertices_from_neighbours", summary.normals.from_neighbours},
        {"vertices_from_template", summary.normals.from_template},
        {"vertices_undefined", summary.normals.undefined},
        {"texels_cancelled", summary.normal_texels_cancelled}}},
  };
  if (!options.normals) json.erase("normal");
  if (options.past == 0) json.erase("velocity");
  if (options.seen_only) json["seen_mean"] = summary.mean_seen;
  if (options.frame == SurfaceFrame::kWorld) {
    json["camera_from_world_rotation"] = Rows(options.camera_pose.camera_from_world_rotation);
    const Eigen::Vector3d& t = options.camera_pose.camera_from_world_translation;
    json["camera_from_world_translation"] = {t.x(), t.y(), t.z()};
  }
  return json.dump(1) + "\n";
}

}  // namespace bodyloom
