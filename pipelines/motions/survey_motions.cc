// SPDX-License-Identifier: Apache-2.0
#include "pipelines/motions/survey_motions.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "pipelines/files.h"
#include "pipelines/report_text.h"

namespace bodyloom {
namespace {

template <typename... Values>
std::string Line(const char* format, Values... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

std::string ClipLine(const SurveyedClip& report) {
  const LibraryClip& clip = report.clip;
  const MotionQuality& q = report.quality;
  const std::string floor = clip.has_floor ? Line("%6.2f", clip.floor_shift_m) : "     -";
  const std::string sliding = std::isfinite(q.foot_sliding_m_s) ? Line("%5.2f", q.foot_sliding_m_s) : "    -";
  return Line("%-40s %-9s %-5s %5.1f %3.0f %5.1f%% %3.0f %4.0f%% %s %s %5d %5.1f %5.0f  %s\n", clip.name.c_str(),
              clip.motion_class.c_str(), clip.test ? "test" : "train", q.seconds, q.fps, 100 * q.beyond_limits_share,
              q.worst_excess_deg, 100 * q.ends_beyond_limits_share, sliding.c_str(), floor.c_str(), q.flips,
              q.worst_speed_m_s, q.worst_acceleration_m_s2, Joined(q.flags).c_str());
}

/// Minutes by key, training and test side by side.
std::string MinutesTable(const std::string& title, const std::map<std::string, double>& train,
                         const std::map<std::string, double>& test) {
  std::set<std::string> keys;
  for (const auto& [key, seconds] : train) keys.insert(key);
  for (const auto& [key, seconds] : test) keys.insert(key);
  const auto seconds_of = [](const std::map<std::string, double>& map, const std::string& key) {
    const auto found = map.find(key);
    return found == map.end() ? 0.0 : found->second;
  };
  std::string text = Line("%-14s %10s %10s\n", title.c_str(), "train min", "test min");
  double train_all = 0, test_all = 0;
  for (const std::string& key : keys) {
    const double a = seconds_of(train, key), b = seconds_of(test, key);
    text += Line("%-14s %10.2f %10.2f\n", key.c_str(), a / 60, b / 60);
    train_all += a;
    test_all += b;
  }
  return text + Line("%-14s %10.2f %10.2f  (%.1f %% test)\n", "all", train_all / 60, test_all / 60,
                     100 * test_all / std::max(train_all + test_all, 1e-9));
}

nlohmann::ordered_json ClipJson(const SurveyedClip& report) {
  const LibraryClip& clip = report.clip;
  const MotionQuality& q = report.quality;
  return {{"name", clip.name},
          {"source", clip.source},
          {"subject", clip.subject},
          {"class", clip.motion_class},
          {"test", clip.test},
          {"in_split", clip.is_named},
          {"frames", q.frames},
          {"seconds", q.seconds},
          {"fps", q.fps},
          {"source_fps", clip.source_fps},
          {"has_floor", clip.has_floor},
          {"floor_shift_m", clip.floor_shift_m},
          {"floor_flat_share", clip.floor_flat_share},
          {"frames_recorded", clip.frames_recorded},
          {"frames_mended", clip.frames_mended},
          {"frames_broken", clip.frames_broken},
          {"jumps", clip.jumps},
          {"gaps", clip.gaps},
          {"frames_dropped", clip.frames_dropped},
          {"beyond_limits_share", q.beyond_limits_share},
          {"worst_excess_deg", q.worst_excess_deg},
          {"worst_excess_joint", q.worst_excess_joint},
          {"foot_sliding_m_s", q.foot_sliding_m_s},
          {"foot_sliding_p95_m_s", q.foot_sliding_p95_m_s},
          {"contact_share", q.contact_share},
          {"sunk_share", q.sunk_share},
          {"deepest_m", q.deepest_m},
          {"ends_beyond_limits_share", q.ends_beyond_limits_share},
          {"ends_worst_excess_deg", q.ends_worst_excess_deg},
          {"ends_worst_excess_joint", q.ends_worst_excess_joint},
          {"rotation_flips", q.flips},
          {"ends_rotation_flips", q.ends_flips},
          {"worst_speed_m_s", q.worst_speed_m_s},
          {"worst_speed_joint", q.worst_speed_joint},
          {"worst_acceleration_m_s2", q.worst_acceleration_m_s2},
          {"worst_acceleration_joint", q.worst_acceleration_joint},
          {"worst_turn_rad_s", q.worst_turn_rad_s},
          {"worst_turn_joint", q.worst_turn_joint},
          {"flags", q.flags}};
}

}  // namespace

SurveyMotionsReport SurveyMotions(const SurveyMotionsRequest& request, const PipelineCallbacks& callbacks) {
  for (const std::string& path : request.motions) RequireReadable(path, "motions");
  RequireReadable(request.options.split_path, "split");
  RequireDistinct({request.options.split_path}, {request.json, request.sheet});
  for (const std::string& path : {request.json, request.sheet}) RequireWritable(path);
  SurveyMotionsReport report;
  std::vector<Image> strips;
  report.library = VisitMotionLibrary(request.motions, request.options, [&](LibraryClip&& clip) {
    callbacks.Update("measure", 0);
    const MotionQuality quality = MeasureMotionQuality(clip.motion, clip.has_floor);
    if (!request.sheet.empty()) {
      const std::string label = Line("%s   %s, %s, %.1f s  %s", clip.name.c_str(), clip.motion_class.c_str(),
                                     clip.test ? "TEST" : "train", quality.seconds, Joined(quality.flags, " ").c_str());
      strips.push_back(DrawMotionStrip(clip.motion, clip.has_floor, label, request.picture));
    }
    clip.motion = Motion();
    report.clips.push_back({std::move(clip), quality});
  });
  if (report.clips.empty()) {
    const std::vector<std::pair<std::string, std::string>>& left_out = report.library.left_out;
    throw std::runtime_error(request.motions[0] + ": no motions, " + std::to_string(left_out.size()) +
                             " files left out" + (left_out.empty() ? "" : ", the first: " + left_out[0].second));
  }
  if (!request.json.empty()) WriteFileAtomically(request.json, ToJson(report));
  if (!request.sheet.empty()) WriteImage(request.sheet, MotionSheet(strips, request.picture));
  return report;
}

std::string ToText(const SurveyMotionsReport& report) {
  const std::vector<SurveyedClip>& clips = report.clips;
  const MotionLibrarySummary& summary = report.library;
  std::string text = Line("%-40s %-9s %-5s %5s %3s %6s %3s %5s %5s %6s %5s %5s %5s  %s\n", "clip", "class", "split",
                          "s", "fps", "limits", "deg", "ends", "slide", "floor", "flips", "speed", "acc", "flags");
  for (const SurveyedClip& surveyed : clips) text += ClipLine(surveyed);
  text += "\n" + MinutesTable("class", summary.train_seconds_by_class, summary.test_seconds_by_class);
  text += "\n" + MinutesTable("source", summary.train_seconds_by_source, summary.test_seconds_by_source) + "\n";
  for (const SurveyedClip& surveyed : clips) {
    const LibraryClip& clip = surveyed.clip;
    if (clip.frames_mended + clip.jumps + clip.gaps + clip.frames_dropped == 0) continue;
    text += Line("cleaned   %s: of %d frames %d dropped (%d broken, %d impossible steps, %d gaps), feet mended in %d\n",
                 clip.name.c_str(), clip.frames_recorded, clip.frames_dropped, clip.frames_broken, clip.jumps,
                 clip.gaps, clip.frames_mended);
  }
  for (const auto& [file, reason] : summary.left_out) text += "left out  " + file + ": " + reason + "\n";
  for (const std::string& warning : summary.warnings) text += "warning   " + warning + "\n";
  for (const std::string& name : summary.unnamed) {
    text += "unnamed   " + name + ": not in the split, taken for training, class other\n";
  }
  return text + Line("%d clips, %.2f minutes, %zu files left out, %zu clips not in the split\n", summary.clips,
                     summary.seconds / 60, summary.left_out.size(), summary.unnamed.size());
}

std::string ToJson(const SurveyMotionsReport& report) {
  const MotionLibrarySummary& summary = report.library;
  nlohmann::ordered_json clips = nlohmann::ordered_json::array(), left_out = clips;
  for (const SurveyedClip& surveyed : report.clips) clips.push_back(ClipJson(surveyed));
  for (const auto& [file, reason] : summary.left_out) left_out.push_back({{"file", file}, {"reason", reason}});
  const nlohmann::ordered_json json = {{"num_clips", summary.clips},
                                       {"seconds", summary.seconds},
                                       {"train_seconds_by_source", summary.train_seconds_by_source},
                                       {"test_seconds_by_source", summary.test_seconds_by_source},
                                       {"train_seconds_by_class", summary.train_seconds_by_class},
                                       {"test_seconds_by_class", summary.test_seconds_by_class},
                                       {"not_in_split", summary.unnamed},
                                       {"left_out", left_out},
                                       {"warnings", summary.warnings},
                                       {"clips", clips}};
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace bodyloom
