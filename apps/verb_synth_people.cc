// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/synthesis/synthesize_people.h"

namespace bodyloom {
namespace {

constexpr const char* kSynthPeopleFooter =
    "Writes a multi-person dataset: a folder of single-person datasets, one a person, action and view, and\n"
    "people.json, which says who is kept for testing. Everything of a person comes from the seed: body, clothes\n"
    "(suit, skirt or coat; --clothes), colours and light. Each action is a stretch of a motion chosen at\n"
    "random; the camera follows the person.\n"
    "Examples:\n"
    "  bodyloom synth-people --motions demo --out people --people 4 --sheet people.png\n"
    "  bodyloom synth-people --motions motion/ --out people --people 60 --actions 5 --views 4 --size 256\n\n";

struct SynthPeopleArguments {
  SynthesizePeopleRequest request;
  std::string clothes = "patterned", light_style = "studio";
  bool quiet = false;
};

void SynthPeople(const SynthPeopleArguments& arguments) {
  SynthesizePeopleRequest request = arguments.request;
  request.set.style = ClothesStyleFromString(arguments.clothes);
  request.set.light_style = LightStyleFromString(arguments.light_style);
  const SynthesizePeopleReport report = SynthesizePeople(request, CommandCallbacks(arguments.quiet));
  if (!arguments.quiet) std::cout << ToText(report);
}

}  // namespace

void AddSynthPeopleVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("synth-people", "Makes images of many dressed people with known truth");
  verb->footer(std::string(kSynthPeopleFooter) + kExitCodeHelp);
  auto arguments = std::make_shared<SynthPeopleArguments>();
  SynthesizePeopleRequest& c = arguments->request;
  const CLI::Range many(1, 999);
  verb->add_option("--motions", c.motions, "a folder of motion files, one such file, or the word demo; may be repeated")
      ->required();
  verb->add_option("--out", c.out, "the folder to write")->required()->type_name("DIR");
  verb->add_option("--people", c.set.people, "how many people")->check(many)->capture_default_str();
  verb->add_option("--actions", c.set.actions, "of each person")->check(many)->capture_default_str();
  verb->add_option("--views", c.set.views, "cameras around each action")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  verb->add_option("--frames", c.set.frames, "images of an action and view")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  verb->add_option("--every", c.set.every, "frames of the motion (30 a second) from one image to the next")
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
  verb->add_option("--clothes", arguments->clothes,
                   "patterned (what shows best how a surface moves) or everyday (what people wear: mostly plain, wide "
                   "trousers and loose shirts among them)")
      ->check(CLI::IsMember({"patterned", "everyday"}))
      ->capture_default_str();
  verb->add_option(
          "--light-style", arguments->light_style,
          "studio (even, with bright rims, no shadows) or natural (from anywhere around, even or hard, with shadows)")
      ->check(CLI::IsMember({"studio", "natural"}))
      ->capture_default_str();
  verb->add_option("--seed", c.set.seed, "same seed, same files")->capture_default_str();
  verb->add_option("--body", c.body, BodyHelp("body model"))->type_name("FILE");
  verb->add_option("--sheet", c.sheet, "also write a contact sheet, .png or .jpg")->type_name("FILE");
  verb->add_option("--threads", c.set.num_threads, "0: all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  verb->add_flag("--quiet", arguments->quiet, "no words on the screen");
  verb->callback([arguments, action] { *action = [arguments] { SynthPeople(*arguments); }; });
}

}  // namespace bodyloom
