// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_people_report.h"
#include "pipelines/detect/cut_masks.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "geometry/base/check.h"
#include "pipelines/report_json.h"
#include "pipelines/report_text.h"
#include "pipelines/track/clip_camera_path.h"
#include "pipelines/track/track_report.h"

namespace bodyloom {
namespace {

using Json = nlohmann::ordered_json;

/// "person 1 21 frames, 1.03 to 1.77 s, 228 px tall: "
std::string SeenText(int number, const FoundPerson& seen) {
  return Concatenate("person ", number, " ", seen.frames, " frames, ", Fixed(seen.first_s, 2), " to ",
                     Fixed(seen.last_s, 2), " s, ", Fixed(seen.height_px, 0), " px tall: ");
}

std::string PersonText(const TrackedPerson& person) {
  std::string text = SeenText(person.number, person.seen);
  if (person.track.empty()) return text + "could not be tracked (" + person.solve.message + ")\n";
  text +=
      person.solve.FramesReport() + "; 2D joints: median " + Fixed(person.solve.reprojection_median_px, 2) + " px\n";
  if (person.solve.stature_m > 0) {
    text += "         taken to be " + Fixed(person.solve.stature_m, 2) + " m tall\n";
  }
  text += FittedPartsText(person.solve);
  if (!person.views.empty()) text += "         seen by " + Joined(person.views) + "\n";
  if (person.room.frames > 0) text += "         " + person.room.BriefReport() + "\n";
  if (person.solve.flights.flights > 0) text += "         " + person.solve.flights.BriefReport() + "\n";
  if (person.seen.joined > 0) {
    text += Concatenate("         found ", person.seen.joined + 1, " times over in the same body, joined\n");
  }
  if (person.hidden.any()) {
    text += Concatenate("         partly hidden by others in ", person.hidden.frames, " frames\n");
  }
  return text;
}

std::string SceneText(const SharedScene& scene) {
  std::string text;
  if (scene.focal_px > 0) {
    text += "camera   focal length " + Fixed(scene.focal_px, 1) + " px" +
            (scene.focal_log_sigma == 0 ? ", known" : FocalSigmaText(scene.focal_log_sigma)) + "\n";
  }
  if (scene.has_up && scene.ground.has_plane) {
    text += "ground   " + Fixed(scene.ground.camera_height_m, 2) + " m below the camera (" + scene.why + ")\n";
  } else {
    text += "ground   none: " + scene.why + "\n";
  }
  return text;
}

Json SceneJson(const SharedScene& scene) {
  Json json = {{"focal_px", scene.focal_px}, {"focal_log_sigma", scene.focal_log_sigma}, {"ground", scene.why}};
  if (scene.has_up) {
    const Eigen::Vector3d& up = scene.ground.up;
    json["up_in_camera"] = {up.x(), up.y(), up.z()};
    if (scene.ground.has_plane) json["camera_height_m"] = scene.ground.camera_height_m;
  }
  return json;
}

Json PersonJson(const TrackedPerson& person) {
  const TrackSequenceSummary& solve = person.solve;
  Json json = {{"number", person.number},
               {"track", person.track},
               {"frames", person.seen.frames},
               {"joined", person.seen.joined},
               {"first_s", person.seen.first_s},
               {"last_s", person.seen.last_s},
               {"height_px", person.seen.height_px},
               {"visible", person.seen.visible},
               {"status", ToString(solve.status)},
               {"message", solve.message},
               {"frames_by_status", solve.frames_by_status},
               {"lost_in_holes", solve.lost_in_holes},
               {"reprojection_median_px", solve.reprojection_median_px},
               {"reprojection_p95_px", solve.reprojection_p95_px},
               {"focal_px", solve.focal_px},
               {"stature_m", solve.stature_m},
               {"swaps_repaired", solve.num_swaps_repaired},
               {"hidden_frames", person.hidden.frames},
               {"fitted_again", person.fitted_again},
               {"room", ToJson(person.room)}};
  AddJumps(solve.flights, &json);
  AddFittedParts(solve, &json);
  if (!person.views.empty()) json["views"] = person.views;
  return json;
}

/// "read 0.43 (98 %), detect 63.70 (187 %)": seconds, and the share of processor time, 100 % for one busy core.
std::string StagesWithShares(const TrackPeopleReport& report) {
  constexpr double kNoTime = 1e-9;
  std::string text;
  for (size_t i = 0; i < report.seconds.size(); ++i) {
    const auto& [stage, seconds] = report.seconds[i];
    const double share = report.processor_seconds.at(i).second / std::max(kNoTime, seconds);
    text += Concatenate(i == 0 ? "" : ", ", stage, " ", Fixed(seconds, 2), " (", Fixed(100 * share, 0), " %)");
  }
  return text;
}

}  // namespace

std::string ToText(const TrackPeopleReport& report) {
  std::string text = Concatenate("frames   ", report.num_frames, " of ", report.width, "x", report.height, " pixels, ",
                                 Fixed(report.fps, 2), " a second\n");
  text += ToText(report.views);
  for (const TrackedPerson& person : report.people) text += PersonText(person);
  constexpr size_t kMostTold = 10;
  const std::vector<LeftOutPerson>& left_out = report.left_out;
  for (size_t i = 0; i < std::min(kMostTold, left_out.size()); ++i) {
    text += "left out " + SeenText(left_out[i].number, left_out[i].seen) + left_out[i].why + "\n";
  }
  if (left_out.size() > kMostTold) text += Concatenate("left out ", left_out.size() - kMostTold, " more\n");
  text += ToText(report.hands_and_faces);
  if (report.masks_cut) text += Concatenate("masks    ", MasksText(*report.masks_cut), "\n");
  text += ToText(report.camera_path, report.camera_scale);
  text += SceneText(report.scene);
  if (std::any_of(report.people.begin(), report.people.end(),
                  [](const auto& person) { return !person.track.empty(); })) {
    text += "world    " + report.world.BriefReport() + "\n";
  }
  text += "time     " + Fixed(report.total_seconds, 2) + " s (" + StagesWithShares(report) + "), " +
          Fixed(report.num_frames / std::max(1e-9, report.total_seconds), 1) + " frames a second with " +
          report.network + "\n";
  text += "memory   " + Fixed(double(report.peak_memory_bytes) / (1 << 20), 0) + " MiB at most\n";
  for (const std::string& path : report.outputs) text += "wrote    " + path + "\n";
  return text;
}

std::string ToJson(const TrackPeopleReport& report) {
  Json people = Json::array();
  for (const TrackedPerson& person : report.people) people.push_back(PersonJson(person));
  Json left_out = Json::array();
  for (const LeftOutPerson& person : report.left_out) {
    left_out.push_back({{"number", person.number},
                        {"frames", person.seen.frames},
                        {"first_s", person.seen.first_s},
                        {"last_s", person.seen.last_s},
                        {"why", person.why}});
  }
  Json json = {{"video", report.video},
               {"image_size", {report.width, report.height}},
               {"frames", report.num_frames},
               {"fps", report.fps},
               {"network", report.network},
               {"people_found", report.num_found},
               {"people", people},
               {"left_out", left_out},
               {"scene", SceneJson(report.scene)},
               {"world", ToJson(report.world)},
               {"seconds", ToJson(report.seconds)},
               {"processor_seconds", ToJson(report.processor_seconds)},
               {"total_seconds", report.total_seconds},
               {"peak_memory_bytes", report.peak_memory_bytes},
               {"outputs", report.outputs}};
  for (const ViewReport& view : report.views) json["views"].push_back(ToJson(view));
  AddHandsAndFaces(report.hands_and_faces, &json);
  if (report.masks_cut) json["masks_cut"] = *report.masks_cut;
  if (report.camera_path.any() || !report.camera_path.motion.empty())
    json["camera_path"] = ToJson(report.camera_path, report.camera_scale);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bodyloom
