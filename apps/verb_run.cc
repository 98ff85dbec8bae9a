// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/progress.h"
#include "apps/track_options.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/track/run_estimate.h"
#include "pipelines/track/track_people_in_videos.h"

namespace bodyloom {
namespace {

constexpr const char* kRunFooter =
    "Writes detections.npz, person_0.npz, person_1.npz ... (0 is the largest and longest in view), overlay.mp4 and\n"
    "summary.json into the folder. Everybody is tracked in one camera frame, with one focal length and one ground.\n"
    "With several videos of the same people also rig.json, and detections_NAME.npz and overlay_NAME.mp4 of each.\n"
    "Examples:\n"
    "  bodyloom run clip.mp4 --out results\n"
    "  the man in front alone, faster, and from his side:\n"
    "    bodyloom run clip.mp4 --out results --people 1 --detector full --side-view\n"
    "  two phones on tripods, nothing known of them:\n"
    "    bodyloom run left.mp4 right.mp4 --out results --report\n"
    "  how long it will take:\n"
    "    bodyloom run clip.mp4 --plan\n"
    "  seconds 3 to 8 of a calibrated camera:\n"
    "    bodyloom run clip.mp4 --out results --cameras calibration.json --view cam1 --from 3 --to 8\n"
    "then\n"
    "  bodyloom export --track results/person_0.npz --what bvh --out motion.bvh\n\n";

}  // namespace

void AddRunVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("run", "A raw video to everybody in it: detected, linked, tracked, drawn");
  verb->footer(std::string(kRunFooter) + kExitCodeHelp);
  auto request = std::make_shared<TrackPeopleInVideosRequest>();
  auto quiet = std::make_shared<bool>(false);
  auto no_overlay = std::make_shared<bool>(false);
  auto plan = std::make_shared<bool>(false), json = std::make_shared<bool>(false);
  verb->add_option("--out", request->out, "folder for the results, made when it is not there (required unless --plan)")
      ->type_name("DIR");
  AddRunVideosOptions(*verb, request.get());
  verb->add_flag("--report", request->report, "write report.html too: video, bodies in 3D and a timeline in one page");
  verb->add_flag("--no-overlay", *no_overlay, "draw no video");
  verb->add_flag("--quiet", *quiet, "no progress and no summary on the screen");
  verb->add_flag("--plan", *plan, "detect people in the first second and estimate time and memory; write nothing");
  verb->add_flag("--json", *json, "with --plan: the estimate as JSON");
  verb->callback([=] {
    *action = [=] {
      request->overlay = !*no_overlay;
      if (*json && !*plan) throw RequestError("--json is the form of --plan: summary.json is always written");
      const PipelineCallbacks callbacks = CommandCallbacks(*quiet || *json);
      if (*plan) {
        if (HasSeveralVideos(*request)) throw RequestError("--plan estimates the run of one video: give one");
        const RunPlan estimate = PlanRun(RequestOfOneVideo(*request), callbacks);
        std::cout << (*json ? ToJson(estimate) : ToText(estimate));
        return;
      }
      const TrackPeopleReport report = HasSeveralVideos(*request)
                                           ? TrackPeopleInVideos(*request, callbacks)
                                           : TrackPeopleClip(RequestOfOneVideo(*request), callbacks);
      if (!*quiet) std::cout << ToText(report);
    };
  });
}

}  // namespace bodyloom
