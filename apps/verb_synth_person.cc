// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/progress.h"
#include "apps/synth_options.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/synthesis/synthesize_person.h"

namespace bodyloom {
namespace {

constexpr const char* kSynthPersonFooter =
    "Writes a folder: images, labels (background top bottom face hair skin shoes), normals of the clothed surface, IUV "
    "of\n"
    "the body, backgrounds, the true track (track.npz) and person.json. The seed makes the person, the clothes' "
    "colours,\n"
    "the light and the background: the same seed with another motion is the same person.\n"
    "Examples:\n"
    "  bodyloom synth-person --motion demo --out person --garment skirt --sheet person.png\n"
    "  bodyloom synth-person --motion dance.pkl --out train --frames 600 --seed 3\n"
    "  bodyloom synth-person --motion walk.bvh --motion run.bvh --out test --seed 3 --garment coat --yaw 30 --size "
    "512\n\n";

struct SynthPersonArguments {
  SynthesizePersonRequest request;
  std::string garment = "skirt", clothes = "patterned", material = "cotton", light_style = "studio";
  bool quiet = false;
};

void SynthPerson(const SynthPersonArguments& arguments) {
  SynthesizePersonRequest request = arguments.request;
  request.set.garment = GarmentKindFromString(arguments.garment);
  request.set.style = ClothesStyleFromString(arguments.clothes);
  request.set.material = ClothMaterialFromString(arguments.material);
  request.set.light_style = LightStyleFromString(arguments.light_style);
  const SynthesizePersonReport report = SynthesizePerson(request, CommandCallbacks(arguments.quiet));
  if (!arguments.quiet) std::cout << ToText(report);
}

}  // namespace

void AddSynthPersonVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("synth-person", "Makes images of a dressed person with known truth");
  verb->footer(std::string(kSynthPersonFooter) + kExitCodeHelp);
  auto arguments = std::make_shared<SynthPersonArguments>();
  SynthesizePersonRequest& c = arguments->request;
  verb->add_option("--motion", c.motions, std::string(kMotionHelp) + "; several follow each other with a gap")
      ->required();
  verb->add_option("--out", c.out, "the folder to write")->required()->type_name("DIR");
  verb->add_option("--garment", arguments->garment, "skirt, coat (both loose) or suit (tight)")
      ->check(CLI::IsMember({"skirt", "coat", "suit"}))
      ->capture_default_str();
  verb->add_option("--clothes", arguments->clothes, "patterned, or everyday: mostly plain, wide and loose among them")
      ->check(CLI::IsMember({"patterned", "everyday"}))
      ->capture_default_str();
  verb->add_option("--material", arguments->material,
                   "of a loose garment: cotton, silk (light, many folds) or denim (heavy, stiff)")
      ->check(CLI::IsMember({"cotton", "silk", "denim"}))
      ->capture_default_str();
  verb->add_option("--seed", c.set.seed, "the person; same seed, same files")->capture_default_str();
  verb->add_option(
          "--light-style", arguments->light_style,
          "studio (even, with bright rims, no shadows) or natural (from anywhere around, even or hard, with shadows)")
      ->check(CLI::IsMember({"studio", "natural"}))
      ->capture_default_str();
  verb->add_option("--light-seed", c.set.light_seed, "another light on the same person (default: the seed's)");
  verb->add_option("--light", c.light, "also write the light, JSON as `bodyloom animate motion --relight` takes it")
      ->type_name("FILE");
  verb->add_option("--size", c.set.size_px, "pixels, width and height")
      ->check(CLI::Range(32, 4096))
      ->capture_default_str();
  verb->add_option("--first", c.motion.first_frame, "first frame of each motion that is used")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--frames", c.motion.num_frames, "how many frames of each motion (0: all)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--fps", c.motion.fps, "resample the motion to this rate (0: as the file has it)")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  verb->add_option(
          "--speed", c.speeds,
          "plays each motion so many times as fast; several: at each of them, one after the other. --first and "
          "--frames count frames at speed 1: the same poses at any speed")
      ->check(CLI::Range(0.05, 20.0))
      ->capture_default_str();
  verb->add_option("--yaw", c.set.yaw_deg, "of the camera about the vertical, degrees; 0 sees the front")
      ->capture_default_str();
  verb->add_option("--elevation", c.set.elevation_deg, "degrees from above")
      ->check(CLI::Range(-60.0, 60.0))
      ->capture_default_str();
  verb->add_option("--shape", c.set.shape_sigma, "how far bodies of different seeds differ, standard deviations")
      ->check(CLI::Range(0.0, 2.0))
      ->capture_default_str();
  verb->add_option("--body", c.body, BodyHelp("body model"))->type_name("FILE");
  verb->add_option("--sheet", c.sheet, "also write a contact sheet, .png or .jpg")->type_name("FILE");
  verb->add_option("--threads", c.set.num_threads, "0: all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  verb->add_flag("--quiet", arguments->quiet, "no words on the screen");
  verb->callback([arguments, action] { *action = [arguments] { SynthPerson(*arguments); }; });
}

}  // namespace bodyloom
