// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/verbs.h"
#include "bodyloom/data_tools/evaluation/motion_quality.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/motion_library.h"
#include "bodyloom/data_tools/motion/motion_sheet.h"
#include "bodyloom/data_tools/motion/motion_split.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

constexpr const char* kFooter =
    "The table, a line a clip:\n"
    "  limits   share of frames with a joint of the body more than 5 degrees beyond its limits, and the worst excess\n"
    "  ends     the same share for ankles, toes and wrists\n"
    "  skate    mean horizontal speed of the slower toe that is within 5 cm of the floor, m/s\n"
    "  floor    height of the floor in the recording's own world, m; - where the ground is not flat\n"
    "  flips    joint rotations of more than 20 rad/s that turn back in the next frame\n"
    "  speed    fastest joint relative to the pelvis, m/s; acc: hardest acceleration, m/s2\n"
    "  flags    what is suspicious; docs/motion_library.md says when\n"
    "The split is a text, one line a clip: name class train|test.\n"
    "Example:\n"
    "  bodyloom motions --motions motion/ --motions aistpp/motions --json motions.json --sheet motions.png\n\n";

struct MotionsCommand {
  std::vector<std::string> motions;
  std::string json, sheet;
  MotionLibraryOptions options;
  MotionSheetOptions picture;
};

struct ClipReport {
  LibraryClip clip;  ///< without its motion
  MotionQuality quality;
};

std::string Joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

template <typename... Values>
std::string Line(const char* format, Values... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

std::string ClipLine(const ClipReport& report) {
  const LibraryClip& clip = report.clip;
  const MotionQuality& q = report.quality;
  const std::string floor = clip.has_floor ? Line("%6.2f", clip.floor_shift_m) : "     -";
  const std::string skate = std::isfinite(q.skate_m_s) ? Line("%5.2f", q.skate_m_s) : "    -";
  return Line("%-40s %-9s %-5s %5.1f %3.0f %5.1f%% %3.0f %4.0f%% %s %s %5d %5.1f %5.0f  %s\n", clip.name.c_str(),
              clip.motion_class.c_str(), clip.test ? "test" : "train", q.seconds, q.fps, 100 * q.beyond_limits_share,
              q.worst_excess_deg, 100 * q.ends_beyond_limits_share, skate.c_str(), floor.c_str(), q.flips,
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

std::string Text(const std::vector<ClipReport>& reports, const MotionLibrarySummary& summary) {
  std::string text = Line("%-40s %-9s %-5s %5s %3s %6s %3s %5s %5s %6s %5s %5s %5s  %s\n", "clip", "class", "split",
                          "s", "fps", "limits", "deg", "ends", "skate", "floor", "flips", "speed", "acc", "flags");
  for (const ClipReport& report : reports) text += ClipLine(report);
  text += "\n" + MinutesTable("class", summary.train_seconds_by_class, summary.test_seconds_by_class);
  text += "\n" + MinutesTable("source", summary.train_seconds_by_source, summary.test_seconds_by_source) + "\n";
  for (const ClipReport& report : reports) {
    const LibraryClip& clip = report.clip;
    if (clip.frames_mended + clip.jumps + clip.gaps + clip.frames_dropped == 0) continue;
    text += Line("cleaned   %s: of %d frames %d dropped (%d broken, %d impossible steps, %d gaps), feet mended in %d\n",
                 clip.name.c_str(), clip.frames_recorded, clip.frames_dropped, clip.frames_broken, clip.jumps,
                 clip.gaps, clip.frames_mended);
  }
  for (const auto& [file, reason] : summary.left_out) text += "left out  " + file + ": " + reason + "\n";
  for (const std::string& name : summary.unnamed) {
    text += "unnamed   " + name + ": not in the split, taken for training, class other\n";
  }
  return text + Line("%d clips, %.2f minutes, %zu files left out, %zu clips not in the split\n", summary.clips,
                     summary.seconds / 60, summary.left_out.size(), summary.unnamed.size());
}

nlohmann::ordered_json ClipJson(const ClipReport& report) {
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
          {"skate_m_s", q.skate_m_s},
          {"skate_p95_m_s", q.skate_p95_m_s},
          {"contact_share", q.contact_share},
          {"sunk_share", q.sunk_share},
          {"deepest_m", q.deepest_m},
          {"ends_beyond_limits_share", q.ends_beyond_limits_share},
          {"ends_worst_excess_deg", q.ends_worst_excess_deg},
          {"ends_worst_excess_joint", q.ends_worst_excess_joint},
          {"flips", q.flips},
          {"ends_flips", q.ends_flips},
          {"worst_speed_m_s", q.worst_speed_m_s},
          {"worst_speed_joint", q.worst_speed_joint},
          {"worst_acceleration_m_s2", q.worst_acceleration_m_s2},
          {"worst_acceleration_joint", q.worst_acceleration_joint},
          {"worst_turn_rad_s", q.worst_turn_rad_s},
          {"worst_turn_joint", q.worst_turn_joint},
          {"flags", q.flags}};
}

std::string Json(const std::vector<ClipReport>& reports, const MotionLibrarySummary& summary) {
  nlohmann::ordered_json clips = nlohmann::ordered_json::array(), left_out = clips;
  for (const ClipReport& report : reports) clips.push_back(ClipJson(report));
  for (const auto& [file, reason] : summary.left_out) left_out.push_back({{"file", file}, {"reason", reason}});
  const nlohmann::ordered_json json = {{"num_clips", summary.clips},
                                       {"seconds", summary.seconds},
                                       {"train_seconds_by_source", summary.train_seconds_by_source},
                                       {"test_seconds_by_source", summary.test_seconds_by_source},
                                       {"train_seconds_by_class", summary.train_seconds_by_class},
                                       {"test_seconds_by_class", summary.test_seconds_by_class},
                                       {"not_in_split", summary.unnamed},
                                       {"left_out", left_out},
                                       {"clips", clips}};
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void RunMotions(const MotionsCommand& command) {
  for (const std::string& path : command.motions) RequireReadable(path, "motions");
  RequireReadable(command.options.split_path, "split");
  RequireDistinct({command.options.split_path}, {command.json, command.sheet});
  for (const std::string& path : {command.json, command.sheet}) RequireWritable(path);
  std::vector<ClipReport> reports;
  std::vector<Image> strips;
  const MotionLibrarySummary summary = VisitMotionLibrary(command.motions, command.options, [&](LibraryClip&& clip) {
    ThrowIfInterrupted();
    const MotionQuality quality = MeasureMotionQuality(clip.motion, clip.has_floor);
    if (!command.sheet.empty()) {
      const std::string label = Line("%s   %s, %s, %.1f s  %s", clip.name.c_str(), clip.motion_class.c_str(),
                                     clip.test ? "TEST" : "train", quality.seconds, Joined(quality.flags).c_str());
      strips.push_back(DrawMotionStrip(clip.motion, clip.has_floor, label, command.picture));
    }
    clip.motion = Motion();
    reports.push_back({std::move(clip), quality});
  });
  if (reports.empty()) {
    throw std::runtime_error(command.motions[0] + ": no motions, " + std::to_string(summary.left_out.size()) +
                             " files left out" +
                             (summary.left_out.empty() ? "" : ", the first: " + summary.left_out[0].second));
  }
  if (!command.json.empty()) WriteFileAtomically(command.json, Json(reports, summary));
  if (!command.sheet.empty()) WriteImage(command.sheet, MotionSheet(strips, command.picture));
  std::cout << Text(reports, summary);
}

}  // namespace

void AddMotionsVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("motions", "Collects motions for training: quality, classes, split, pictures");
  verb->footer(std::string(kFooter) + kExitCodeHelp);
  auto command = std::make_shared<MotionsCommand>();
  MotionsCommand& c = *command;
  verb->add_option("--motions", c.motions, "motion files, or folders of them (BVH, ASF/AMC, AMASS, ...)")
      ->required()
      ->type_name("PATH");
  verb->add_option("--split", c.options.split_path, "classes and train/test, a text (default: the project's own)")
      ->type_name("FILE");
  verb->add_option("--fps", c.options.max_fps, "faster motions are resampled to this")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 1000.0));
  verb->add_option("--json", c.json, "the report")->type_name("FILE");
  verb->add_option("--sheet", c.sheet, "stick figures of every clip, .png")->type_name("FILE");
  verb->add_option("--instants", c.picture.instants, "of a clip on the sheet")
      ->capture_default_str()
      ->check(CLI::Range(1, 200));
  verb->add_option("--columns", c.picture.columns, "of clips on the sheet")
      ->capture_default_str()
      ->check(CLI::Range(1, 20));
  verb->callback([command, action] { *action = [command] { RunMotions(*command); }; });
}

}  // namespace bodyloom
