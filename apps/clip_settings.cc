// SPDX-License-Identifier: Apache-2.0
#include "apps/clip_settings.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "apps/track_options.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr const char* kAllClips = "For all clips (a clip's own come first)";

bool IsSwitch(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

/// Takes a switch that the batch has in place of the verb's own output options.
bool TakeSwitch(const std::string& name, const std::string& place, ClipSettings* settings) {
  const auto found = settings->find(name);
  if (found == settings->end()) return false;
  const std::string value = found->second;
  if (value != "true" && value != "false")
    ThrowFileError(place, name, "found " + PrintableText(value) + ", expected true or false");
  if (value == "false") settings->erase(found);
  return value == "true";
}

/// Parses the settings as the arguments of a verb; those that are switched off are taken out.
void Parse(CLI::App* app, const ManifestClip& listed, const std::set<std::string>& outputs, ClipSettings* settings) {
  std::vector<std::string> arguments;
  for (auto setting = settings->begin(); setting != settings->end();) {
    const auto& [name, value] = *setting;
    const CLI::Option* option = app->get_option_no_throw("--" + name);
    if (outputs.contains(name)) {
      ++setting;
      continue;
    }
    if (option == nullptr) {
      ThrowFileError(listed.place, "'" + PrintableText(name) + "' is no option of " + listed.verb +
                                       ", expected one of `bodyloom " + listed.verb + " --help` without its dashes");
    }
    if (IsSwitch(*option) && value != "true" && value != "false") {
      ThrowFileError(listed.place, name, "found " + PrintableText(value) + ", expected true or false");
    }
    if (IsSwitch(*option) && value == "false") {
      setting = settings->erase(setting);
      continue;
    }
    arguments.push_back("--" + name + (IsSwitch(*option) ? "" : "=" + value));
    ++setting;
  }
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  try {
    app->parse(arguments);
  } catch (const CLI::ParseError& error) {
    ThrowFileError(listed.place, error.what());
  }
}

void UseThreads(int num_threads, const ClipSettings& settings, TrackSettings* track) {
  if (!settings.contains("threads")) track->solve.num_threads = num_threads;
  track->detector.blazepose.num_threads = track->solve.num_threads;
}

}  // namespace

std::function<ClipSettings()> AddClipOptions(CLI::App& verb) {
  const std::vector<CLI::Option*> before = verb.get_options();
  auto unused = std::make_shared<TrackPeopleClipRequest>();
  TrackSettings& track = unused->track;
  verb.add_flag("--overlay", unused->overlay, "draw overlay.mp4")->group(kAllClips);
  verb.add_flag("--side-view", unused->side_view, "the overlay also shows the body from its side")->group(kAllClips);
  verb.add_flag("--report", unused->report, "write report.html: video, bodies in 3D and a timeline in one page")
      ->group(kAllClips);
  verb.add_option("--people", unused->max_people, "of raw videos: at most so many (0: everybody)")
      ->group(kAllClips)
      ->check(CLI::NonNegativeNumber);
  verb.add_option("--fps", track.fps, "frame rate of detections and of folders of images that do not say")
      ->group(kAllClips)
      ->check(CLI::PositiveNumber);
  verb.add_option("--min-confidence", track.min_confidence, "landmarks below (0 to 1) count as missing")
      ->group(kAllClips)
      ->check(CLI::Range(0.0, 1.0));
  verb.add_option("--view", track.view, "camera of files that hold several")->group(kAllClips)->type_name("NAME");
  AddDetectionOptions(verb, &track, "as of run and track", "Detection in raw videos");
  AddCalibrationOptions(verb, &track);
  AddCameraPathOptions(verb, &track);
  AddLearnedOptions(verb, &track);
  AddSolveOptions(verb, &track);
  std::vector<const CLI::Option*> added;
  for (const CLI::Option* option : verb.get_options()) {
    if (std::find(before.begin(), before.end(), option) == before.end()) added.push_back(option);
  }
  return [added, unused] {
    ClipSettings given;
    for (const CLI::Option* option : added) {
      if (option->count() > 0) given[option->get_lnames().front()] = option->results().back();
    }
    return given;
  };
}

BatchClip ClipFrom(const ManifestClip& listed, const ClipSettings& common, int num_threads) {
  const std::set<std::string> outputs = {"overlay", "report"};
  BatchClip clip;
  clip.id = listed.id;
  clip.settings = listed.settings;
  CLI::App app;
  TrackRequest track;
  TrackPeopleClipRequest people;
  bool unused = false;
  if (listed.verb == "track") {
    AddTrackOptions(app, &track, &unused);
  } else {
    AddRunOptions(app, &people);
  }
  for (const auto& [name, value] : common) {
    if (outputs.contains(name) || app.get_option_no_throw("--" + name) != nullptr) clip.settings.emplace(name, value);
  }
  clip.overlay = TakeSwitch("overlay", listed.place, &clip.settings);
  clip.report = TakeSwitch("report", listed.place, &clip.settings);
  Parse(&app, listed, outputs, &clip.settings);
  if (listed.verb == "run") {
    UseThreads(num_threads, clip.settings, &people.track);
    clip.request = people;
    return clip;
  }
  UseThreads(num_threads, clip.settings, &track);
  clip.request = track;
  track.out = "track.npz";
  if (clip.overlay) track.overlay = "overlay.mp4";
  try {
    CheckTrackRequest(track);
  } catch (const RequestError& error) {
    ThrowFileError(listed.place, error.what());
  }
  return clip;
}

}  // namespace bodyloom
