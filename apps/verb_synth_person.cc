// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/motion_input.h"
#include "apps/progress.h"
#include "apps/verbs.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/datasets/person_sheet.h"
#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/data_tools/synthesis/people/dressed_person.h"
#include "bodyloom/data_tools/synthesis/people/make_person_set.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

constexpr const char* kFooter =
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

struct SynthPersonCommand {
  std::vector<std::string> motions;
  std::vector<double> speeds = {1};  ///< each motion at each of them
  MotionInput motion;                ///< rate and frames of each
  std::string body, out, sheet, garment = "skirt";
  bool quiet = false;
  MakePersonSetOptions set;
};

/// The command as it would be typed again.
std::string CommandLine(const SynthPersonCommand& c) {
  std::string line = "bodyloom synth-person";
  for (const std::string& motion : c.motions) line += " --motion " + motion;
  line += " --out " + c.out + " --garment " + c.garment;
  line += " --seed " + std::to_string(c.set.seed) + " --size " + std::to_string(c.set.size_px);
  const auto add = [&](const char* option, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), " %s %g", option, value);
    line += text.data();
  };
  if (c.speeds != std::vector<double>{1}) {
    for (const double speed : c.speeds) add("--speed", speed);
  }
  add("--fps", c.motion.fps), add("--yaw", c.set.yaw_deg), add("--elevation", c.set.elevation_deg);
  line += " --first " + std::to_string(c.motion.first_frame) + " --frames " + std::to_string(c.motion.num_frames);
  return c.body.empty() ? line : line + " --body " + c.body;
}

/// All of them in one world with y up.
Motion LoadMotions(const SynthPersonCommand& command, const BodyModel& body) {
  const Eigen::Vector3d pelvis = body.RestJoints(Eigen::VectorXd::Zero(body.num_betas())).row(0).transpose();
  std::vector<Motion> motions;
  for (const std::string& name : command.motions) {
    MotionInput input = command.motion;
    input.motion = name;
    for (const double speed : command.speeds) {
      input.speed = speed;
      motions.push_back(LoadMotionInput(input, body));
      if (command.motions.size() > 1) motions.back() = ChangeUp(motions.back(), Motion::Up::kY, pelvis);
    }
  }
  // So far apart that the cloth of one motion is not led into the next.
  return motions.size() == 1 ? motions.front() : JoinMotions(motions, ClothRunOptions().cut_pause_s);
}

void SynthPerson(SynthPersonCommand command) {
  for (const std::string& motion : command.motions) {
    if (motion != "demo") RequireReadable(motion, "motion");
  }
  if (!(command.motion.fps > 0) && command.speeds != std::vector<double>{1}) {
    throw RequestError("--speed needs --fps: the rate of the pictures");
  }
  RequireReadable(command.body, "body model");
  RequireWritableFolder(command.out);
  RequireWritable(command.sheet);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(command.body);
  const Motion motion = LoadMotions(command, *body);
  ThrowIfInterrupted();
  MakePersonSetOptions& set = command.set;
  set.garment = GarmentKindFromString(command.garment);
  for (const std::string& name : command.motions) {
    set.motion += (set.motion.empty() ? "" : " ") + std::filesystem::path(name).filename().string();
  }
  set.command = CommandLine(command);
  Progress progress("dressing " + std::to_string(motion.num_frames()) + " frames",
                    command.quiet ? Progress::Style::kSilent : Progress::DefaultStyle());
  set.progress = [&](double done) {
    progress.Update("person", done);
    return !IsInterrupted();
  };
  PersonSheet sheet(motion.num_frames());
  if (!command.sheet.empty()) set.look = [&](int t, const PersonFrame& frame) { sheet.Take(t, frame); };
  const MakePersonSetSummary summary = MakePersonSet(command.out, *body, motion, set);
  ThrowIfInterrupted();
  if (!command.sheet.empty()) WriteImage(command.sheet, sheet.Picture());
  if (command.quiet) return;
  std::cout << summary.frames << " frames of " << set.size_px << "x" << set.size_px << " in "
            << ClockText(summary.seconds) << ", " << static_cast<int>(summary.frames_per_second() * 10) / 10.0
            << " a second\n";
  if (summary.cloth_vertices > 0) {
    std::cout << "cloth            " << summary.cloth_vertices << " vertices, "
              << static_cast<int>(1e4 * summary.cloth_seconds / summary.frames) / 10.0
              << " ms a frame, stretched by at most " << static_cast<int>(1000 * summary.largest_stretch) / 10.0
              << " %, " << summary.cuts << " cuts, a leg through it in " << summary.frames_through << " frames\n";
  }
  std::cout << "wrote            " << command.out << "\n";
  if (!command.sheet.empty()) std::cout << "wrote            " << command.sheet << "\n";
}

}  // namespace

void AddSynthPersonVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("synth-person", "Makes pictures of a dressed person with known truth");
  verb->footer(std::string(kFooter) + kExitCodeHelp);
  auto command = std::make_shared<SynthPersonCommand>();
  SynthPersonCommand& c = *command;
  c.motion.fps = 30;
  verb->add_option("--motion", c.motions, std::string(kMotionInputHelp) + "; several follow each other with a gap")
      ->required();
  verb->add_option("--out", c.out, "the folder to write")->required()->type_name("DIR");
  verb->add_option("--garment", c.garment, "skirt, coat (both loose) or suit (tight)")
      ->check(CLI::IsMember({"skirt", "coat", "suit"}))
      ->capture_default_str();
  verb->add_option("--seed", c.set.seed, "the person; same seed, same files")->capture_default_str();
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
  verb->add_option("--body", c.body, "body model (default: the built-in body)")->type_name("FILE");
  verb->add_option("--sheet", c.sheet, "also write a contact sheet, .png or .jpg")->type_name("FILE");
  verb->add_option("--threads", c.set.num_threads, "0: all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  verb->add_flag("--quiet", c.quiet, "no words on the screen");
  verb->callback([command, action] { *action = [command] { SynthPerson(*command); }; });
}

}  // namespace bodyloom
