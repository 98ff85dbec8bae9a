// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/command_callbacks.h"
#include "apps/exit_code.h"
#include "apps/track_options.h"
#include "apps/verbs.h"
#include "bodyloom/pipelines/track/track_people_clip.h"

namespace bodyloom {
namespace {

constexpr const char* kRunFooter =
    "Writes detections.npz, person_0.npz, person_1.npz ... (0 is the largest and longest in view), overlay.mp4 and\n"
    "summary.json into the folder. Everybody is tracked in one camera frame, with one focal length and one ground.\n"
    "Examples:\n"
    "  bodyloom run clip.mp4 --out results\n"
    "  the man in front alone, faster, and from his side:\n"
    "    bodyloom run clip.mp4 --out results --people 1 --detector full --side-view\n"
    "  seconds 3 to 8 of a calibrated camera:\n"
    "    bodyloom run clip.mp4 --out results --cameras calibration.json --view cam1 --from 3 --to 8\n"
    "then\n"
    "  bodyloom export --track results/person_0.npz --what bvh --out motion.bvh\n\n";

}  // namespace

void AddRunVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("run", "A raw video to everybody in it: detected, linked, tracked, drawn");
  verb->footer(std::string(kRunFooter) + kExitCodeHelp);
  auto request = std::make_shared<TrackPeopleClipRequest>();
  auto quiet = std::make_shared<bool>(false);
  auto no_overlay = std::make_shared<bool>(false);
  TrackRequest& track = request->track;
  verb->add_option("VIDEO,--video", track.video, "the video, or a folder of images")->required()->type_name("PATH");
  verb->add_option("--out", request->out, "folder for the results, made when it is not there")
      ->required()
      ->type_name("DIR");
  verb->add_option("--people", request->max_people, "at most so many: the largest and longest in view (0: everybody)")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--person", request->person, "only this one: 0 is the largest and longest in view")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--least-seconds", request->least_seconds, "whoever is seen for less is left out")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--fps", track.fps, "frame rate of a folder of images (default 30)")->check(CLI::PositiveNumber);
  verb->add_option("--min-confidence", track.min_confidence, "landmarks below (0 to 1) count as missing")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb->add_option("--view", track.view, "camera of a calibration that holds several")->type_name("NAME");
  verb->add_flag("--masks", request->masks, "write each person's mask too: mask_0.npz, mask_1.npz ...");
  verb->add_flag("--report", request->report, "write report.html too: video, bodies in 3D and a timeline in one page");
  verb->add_flag("--no-overlay", *no_overlay, "draw no video");
  verb->add_flag("--side-view", track.side_view, "the overlay also shows everybody from their side");
  verb->add_flag("--quiet", *quiet, "no progress and no summary on the screen");
  AddDetectionOptions(*verb, &track, "Detection");
  AddCalibrationOptions(*verb, &track);
  AddLearnedOptions(*verb, &track);
  AddSolveOptions(*verb, &track);
  verb->callback([=] {
    *action = [=] {
      request->overlay = !*no_overlay;
      const TrackPeopleReport report = TrackPeopleClip(*request, CommandCallbacks(*quiet));
      if (!*quiet) std::cout << ToText(report);
    };
  });
}

}  // namespace bodyloom
