// SPDX-License-Identifier: Apache-2.0
#include "apps/run_options.h"

#include <CLI/CLI.hpp>

#include "apps/track_options.h"

namespace bodyloom {

namespace {

/// All but those of the videos and their views.
void AddOtherRunOptions(CLI::App& app, TrackPeopleClipRequest* request) {
  TrackSettings& track = request->track;
  app.add_option("--people", request->max_people, "at most so many: the largest and longest in view (0: everybody)")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  app.add_option("--person", request->person, "only this one: 0 is the largest and longest in view")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--min-seconds", request->min_seconds, "whoever is seen for less is left out")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  app.add_option("--fps", track.fps, "frame rate of a folder of images (default 30)")->check(CLI::PositiveNumber);
  app.add_option("--min-confidence", track.min_confidence, "landmarks below (0 to 1) count as missing")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_flag("--masks", request->masks, "write each person's mask too: mask_0.npz, mask_1.npz ...");
  app.add_flag(
      "--coarse-masks", request->coarse_masks,
      "masks as the network gives them: do not cut them from what stands behind people when the camera is still");
  app.add_flag("--side-view", request->side_view, "the overlay also shows everybody from their side");
  AddDetectionOptions(app, &track, "auto, if --body has fingers or is not given", "Detection");
  AddCalibrationOptions(app, &track);
  AddCameraPathOptions(app, &track);
  AddLearnedOptions(app, &track);
  AddSolveOptions(app, &track);
}

}  // namespace

void AddRunOptions(CLI::App& app, TrackPeopleClipRequest* request) {
  TrackSettings& track = request->track;
  app.add_option("VIDEO,--video", track.video, "the video, or a folder of images")->required()->type_name("PATH");
  app.add_option("--view", track.view, "camera of a calibration that holds several")->type_name("NAME");
  AddOtherRunOptions(app, request);
}

void AddRunVideosOptions(CLI::App& app, TrackPeopleInVideosRequest* request) {
  app.add_option("VIDEO,--video", request->videos,
                 "the video, or a folder of images; several of cameras that filmed the same people and stood still: "
                 "the tracks are in the first one's frame and time")
      ->required()
      ->type_name("PATH ...");
  app.add_option("--view", request->views,
                 "camera of a calibration that holds several; with several videos a name for each, as left,right")
      ->type_name("NAME,...")
      ->allow_extra_args(false)
      ->delimiter(',');
  AddKnownOfRigOptions(app, &request->known, &request->same_lens, "Options");
  AddOtherRunOptions(app, request);
}

}  // namespace bodyloom
