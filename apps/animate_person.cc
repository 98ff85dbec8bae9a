// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/detector_options.h"
#include "apps/exec_beside.h"
#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/photo_avatar/animate_person.h"

namespace bodyloom {
namespace {

void RunAnimatePerson(const AnimatePersonRequest& request) {
  const AnimatePersonSummary summary = RunWithBar("animate", AnimatePerson, request);
  const PhotoPersonReport& person = summary.person;
  if (!person.photos.empty()) {
    std::printf(
        "%.0f %% of the surface is seen, the rest guessed: %.0f %% mirrored, %.0f %% from the other side, "
        "%.0f %% hair, %.0f %% from around the limb, %.0f %% filled smoothly\n",
        100 * person.seen, 100 * person.mirrored, 100 * person.behind, 100 * person.hair, 100 * person.limb_neighbour,
        100 * person.smooth_fill);
    if (person.garment_length_m > 0) {
      std::printf("wears a loose garment, %.0f cm long: a skirt, a dress or a coat\n", 100 * person.garment_length_m);
    }
  }
  if (summary.frames > 0) {
    std::printf("%d frames of %dx%d px, %.1f ms a frame to draw, the first after %.1f s\n", summary.frames,
                summary.width, summary.height, summary.draw_ms, summary.first_frame_s);
  }
  if (summary.frames_without_fit > 0) {
    std::printf("%d frames have no fit and show the background\n", summary.frames_without_fit);
  }
  for (const std::string& path : summary.written) std::cout << "wrote " << path << "\n";
}

}  // namespace

void AddAnimatePerson(CLI::App& animate, Action* action, std::vector<std::string> arguments) {
  CLI::App* verb = animate.add_subcommand("person", "Moves a person from a photo or a few; nothing is trained");
  auto request = std::make_shared<AnimatePersonRequest>();
  PhotoFitSettings& fit = request->photos.fit;
  verb->add_option("--image", request->photos.images, "Photos of the person; the first gives shape and clothes");
  verb->add_option("--kept", request->person, "A person who was kept (--keep), in place of photos")->type_name("DIR");
  verb->add_option("--garment-from", request->garment_from,
                   "Photo of somebody, or the folder of a person who was kept: their clothes are worn");
  verb->add_option("--keep", request->keep,
                   "Folder for the person: body.npz, texture.png, sources.png, labels.png, photo_0.npz, person.json")
      ->type_name("DIR");
  verb->add_option("--track", request->track, "The motion: a track, .npz");
  verb->add_option("--out", request->out, "The video, .mp4");
  verb->add_option("--pictures", request->pictures, "A folder for PNGs of the person with transparency")
      ->type_name("DIR");
  verb->add_option("--moved-track", request->moved_track,
                   "The motion by this person, .npz: with --body DIR/body.npz for render, export, describe");
  verb->add_flag("--own-stature", request->own_stature,
                 "As tall in the track's scene as the photos (or --stature) say, not as tall in the image as whoever "
                 "moved there");
  verb->add_option("--view-yaw", request->view_yaw,
                   "Turns the view about the person's vertical, degrees; FROM:TO turns it over the clip");
  verb->add_option(
      "--freeze", request->freeze,
      "FRAME:COUNT: time stands still at that frame for so many more, while --view-yaw FROM:TO turns the view");
  verb->add_option("--background", request->background, "Image, video or folder of images behind the person");
  verb->add_option("--relight", request->relight,
                   "Other light: an environment (.png, .jpg) or JSON, as of animate motion (default: the photo's)");
  verb->add_option("--size", request->size, "Pixels of the image's longer side (default: as the track's)")
      ->check(CLI::Range(2, 8192));
  verb->add_option("--person", fit.person, "Of several people in a photo: 0 is the largest")->capture_default_str();
  verb->add_option("--texture-size", request->photos.texture_size, "Texels a side")->capture_default_str();
  verb->add_flag("--no-loose-garment{false}", request->photos.loose_garment,
                 "Look for no skirt, dress or coat: all clothes are close to the skin");
  verb->add_option("--body", fit.body, BodyHelp("Body of photos and track"));
  verb->add_option("--focal", fit.focal_px, "The photos' focal length in pixels (default: estimated)");
  verb->add_option("--stature", fit.stature_m, "The person's height in metres (default: average)");
  AddDetectorOptions(*verb, &fit.detector, &fit.detect_rate, "Detection");
  auto scored = std::make_shared<bool>(false);
  verb->add_option_function<std::string>(
          "--score",
          [verb, scored](const std::string&) {
            *scored = true;
            verb->allow_extras();  // options of its own
          },
          "Instead: measure on the test people of a multi-person dataset; needs LibTorch. Its options: bodyloom neural "
          "animate person --help")
      ->type_name("DIR");
  verb->add_option("--json", request->json, "Report with times");
  verb->add_option("--threads", request->threads, "0: all cores")->check(CLI::Range(0, 1024));
  verb->footer(
      "Needs no LibTorch (but for --score) and no training. The pose detector's networks: ./dev models.\n"
      "Examples:\n"
      "  bodyloom animate person --image me.jpg --track dance.npz --out me.mp4\n"
      "  bodyloom animate person --image front.jpg back.jpg --keep me\n"
      "  bodyloom animate person --kept me --garment-from friend.jpg --track dance.npz --out me.mp4\n"
      "  bodyloom animate person --kept me --track dance.npz --view-yaw 0:360 --background b.jpg --out me.mp4");
  verb->callback([request, scored, action, arguments = std::move(arguments)] {
    *action = [=] {
      if (*scored) ExecNeural(arguments);
      RunAnimatePerson(*request);
    };
  });
}

}  // namespace bodyloom
