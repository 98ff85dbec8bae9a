// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "apps/progress.h"
#include "apps/track_options.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/track/track_clip.h"
#include "pipelines/track/track_views_clip.h"

namespace bodyloom {
namespace {

constexpr const char* kTrackFooter =
    "Examples:\n"
    "  a video and nothing else (the networks come with ./dev models):\n"
    "    bodyloom track --video clip.mp4 --out track.npz --overlay overlay.mp4 --side-view\n"
    "  OpenPose's output folder and the video it was made from; the focal length is estimated:\n"
    "    bodyloom track --detections openpose_json/ --video clip.mp4 --out track.npz --overlay overlay.mp4\n"
    "  one calibrated camera of an AIST++ clip:\n"
    "    bodyloom track --detections keypoints2d/SEQ.pkl --view c01 --cameras cameras/ --out track.npz\n"
    "  two phones that filmed the same person, of which nothing is known; the cameras go to rig.json:\n"
    "    bodyloom track --detections left.json --detections right.json --image-size 1920x1080 --out track.npz\n"
    "  two cameras of one file:\n"
    "    bodyloom track --detections keypoints2d/SEQ.pkl --view c01,c03 --cameras cameras/ --out track.npz\n"
    "  a body of your own, and the numbers for a program:\n"
    "    bodyloom track --detections coco.json --image-size 1920x1080 --body SMPL_NEUTRAL.pkl --out t.npz --json "
    "t.json\n"
    "  poses of an image network (WHAM, GVHMR, GEM, PromptHMR, PHALP, VIBE, SAM 3D Body) to start from:\n"
    "    bodyloom track --video clip.mp4 --init wham_output.pkl --out track.npz --json track.json\n"
    "  what would be done, and why not the rest:\n"
    "    bodyloom track --detections coco.json --image-size 1920x1080 --plan\n\n";

void TrackAndReport(const TrackViewsRequest& request, bool quiet) {
  const TrackReport report = HasSeveralViews(request) ? TrackViewsClip(request, CommandCallbacks(quiet))
                                                      : TrackClip(RequestOfOneView(request), CommandCallbacks(quiet));
  if (request.plan) {
    std::cout << report.num_frames << " frames would be tracked:\n" << ToText(report.solve.plan);
  } else if (!quiet) {
    std::cout << ToText(report);
  }
}

}  // namespace

void AddTrackVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("track", "Fits a body to a clip: a video or detections in, track out");
  verb->footer(std::string(kTrackFooter) + kExitCodeHelp);
  auto request = std::make_shared<TrackViewsRequest>();
  auto quiet = std::make_shared<bool>(false);
  AddTrackViewsOptions(*verb, request.get(), quiet.get());
  verb->callback([request, quiet, action] { *action = [request, quiet] { TrackAndReport(*request, *quiet); }; });
}

}  // namespace bodyloom
