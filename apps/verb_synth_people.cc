// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
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
#include "bodyloom/data_tools/datasets/people_sheet.h"
#include "bodyloom/data_tools/motion/motion_library.h"
#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/data_tools/synthesis/people/make_people_set.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

constexpr double kFps = 30;

constexpr const char* kFooter =
    "Writes a folder of person sets, one a person, action and view, and people.json, which says who is kept for "
    "testing.\n"
    "Everything of a person comes from the seed: body, clothes (suit, skirt or coat), colours and light. Each action "
    "is "
    "a\n"
    "stretch of a motion chosen at random; the camera follows the person.\n"
    "Examples:\n"
    "  bodyloom synth-people --motions demo --out people --people 4 --sheet people.png\n"
    "  bodyloom synth-people --motions motion/ --out people --people 60 --actions 5 --views 4 --size 256\n\n";

struct SynthPeopleCommand {
  std::vector<std::string> motions;
  std::string body, out, sheet;
  bool quiet = false;
  MakePeopleSetOptions set;
};

std::string CommandLine(const SynthPeopleCommand& c) {
  std::string line = "bodyloom synth-people";
  for (const std::string& motions : c.motions) line += " --motions " + motions;
  line += " --out " + c.out;
  const auto add = [&](const char* option, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), " %s %g", option, value);
    line += text.data();
  };
  add("--people", c.set.people), add("--actions", c.set.actions), add("--views", c.set.views);
  add("--frames", c.set.frames), add("--every", c.set.every), add("--test-share", c.set.test_share);
  add("--size", c.set.size_px), add("--shape", c.set.shape_sigma);
  line += " --seed " + std::to_string(c.set.seed);
  return c.body.empty() ? line : line + " --body " + c.body;
}

/// Those that are long enough, at the common rate; `short_ones` counts the others.
std::vector<Motion> LoadMotions(const SynthPeopleCommand& command, const BodyModel& body, int* short_ones) {
  std::vector<Motion> motions;
  const int length = (command.set.frames - 1) * command.set.every + 1;
  const auto take = [&](const Motion& motion) {
    Motion resampled = ResampleMotion(motion, kFps);
    if (resampled.num_frames() >= length) {
      motions.push_back(std::move(resampled));
    } else {
      ++*short_ones;
    }
  };
  std::vector<std::string> folders;
  for (const std::string& name : command.motions) {
    if (name != "demo") {
      RequireReadable(name, "motions");
      folders.push_back(name);
      continue;
    }
    MotionInput demo;
    demo.motion = name;
    take(LoadMotionInput(demo, body));
  }
  if (!folders.empty()) {
    VisitMotionLibrary(folders, {}, [&](LibraryClip&& clip) { take(clip.motion); });
  }
  if (motions.empty()) {
    throw RequestError("--motions: none is as long as a clip, " + std::to_string(length) +
                       " frames; give others, or fewer --frames or --every");
  }
  return motions;
}

void SynthPeople(SynthPeopleCommand command) {
  RequireReadable(command.body, "body model");
  RequireWritableFolder(command.out);
  RequireWritable(command.sheet);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(command.body);
  int short_ones = 0;
  const std::vector<Motion> motions = LoadMotions(command, *body, &short_ones);
  ThrowIfInterrupted();
  command.set.command = CommandLine(command);
  Progress progress("dressing " + std::to_string(command.set.people) + " people",
                    command.quiet ? Progress::Style::kSilent : Progress::DefaultStyle());
  command.set.progress = [&](double done) {
    progress.Update("people", done);
    return !IsInterrupted();
  };
  const MakePeopleSetSummary summary = MakePeopleSet(command.out, *body, motions, command.set);
  ThrowIfInterrupted();
  if (!command.sheet.empty()) WriteImage(command.sheet, PeopleSheet(command.out));
  if (command.quiet) return;
  if (short_ones > 0) std::cout << short_ones << " motions were too short for a clip and left out\n";
  const double minutes = summary.seconds / 60;
  std::cout << summary.pictures << " pictures of " << command.set.people << " people in " << ClockText(summary.seconds)
            << ", " << static_cast<int>(summary.pictures / minutes) << " a minute; " << summary.pairs
            << " pairs of two pictures of one person\n"
            << "wrote            " << command.out << "\n";
  if (!command.sheet.empty()) std::cout << "wrote            " << command.sheet << "\n";
}

}  // namespace

void AddSynthPeopleVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("synth-people", "Makes pictures of many dressed people with known truth");
  verb->footer(std::string(kFooter) + kExitCodeHelp);
  auto command = std::make_shared<SynthPeopleCommand>();
  SynthPeopleCommand& c = *command;
  const CLI::Range many(1, 999);
  verb->add_option("--motions", c.motions, "a folder of motion files, one such file, or the word demo; may be repeated")
      ->required();
  verb->add_option("--out", c.out, "the folder to write")->required()->type_name("DIR");
  verb->add_option("--people", c.set.people, "how many people")->check(many)->capture_default_str();
  verb->add_option("--actions", c.set.actions, "of each person")->check(many)->capture_default_str();
  verb->add_option("--views", c.set.views, "cameras around each action")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  verb->add_option("--frames", c.set.frames, "pictures of an action and view")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  verb->add_option("--every", c.set.every, "frames of the motion (30 a second) from one picture to the next")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("--test-share", c.set.test_share, "of the people, kept for testing")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  verb->add_option("--size", c.set.size_px, "pixels, width and height")
      ->check(CLI::Range(32, 4096))
      ->capture_default_str();
  verb->add_option("--shape", c.set.shape_sigma, "how far bodies differ, standard deviations")
      ->check(CLI::Range(0.0, 2.0))
      ->capture_default_str();
  verb->add_option("--seed", c.set.seed, "same seed, same files")->capture_default_str();
  verb->add_option("--body", c.body, "body model (default: the built-in body)")->type_name("FILE");
  verb->add_option("--sheet", c.sheet, "also write a contact sheet, .png or .jpg")->type_name("FILE");
  verb->add_option("--threads", c.set.num_threads, "0: all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  verb->add_flag("--quiet", c.quiet, "no words on the screen");
  verb->callback([command, action] { *action = [command] { SynthPeople(*command); }; });
}

}  // namespace bodyloom
