// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/motions/survey_motions.h"

namespace bodyloom {
namespace {

constexpr const char* kMotionsFooter =
    "The table, a line a clip:\n"
    "  limits   share of frames with a joint of the body more than 5 degrees beyond its limits, and the worst excess\n"
    "  ends     the same share for ankles, toes and wrists\n"
    "  slide    foot sliding: mean horizontal speed of the slower toe that is within 5 cm of the floor, m/s\n"
    "  floor    height of the floor in the recording's own world, m; - where the ground is not flat\n"
    "  flips    joint rotations of more than 20 rad/s that turn back in the next frame\n"
    "  speed    fastest joint relative to the pelvis, m/s; acc: hardest acceleration, m/s2\n"
    "  flags    what is suspicious; docs/motion_library.md says when\n"
    "The split is a text, one line a clip: name class train|test.\n"
    "Example:\n"
    "  bodyloom motions --motions motion/ --motions aistpp/motions --json motions.json --sheet motions.png\n\n";

}  // namespace

void AddMotionsVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("motions", "Collects motions for training: quality, classes, split, images");
  verb->footer(std::string(kMotionsFooter) + kExitCodeHelp);
  auto request = std::make_shared<SurveyMotionsRequest>();
  SurveyMotionsRequest& c = *request;
  verb->add_option("--motions", c.motions, "motion files, or folders of them (BVH, ASF/AMC, AMASS, ...)")
      ->required()
      ->type_name("PATH");
  verb->add_option("--split", c.options.split_path, "classes and train/test, a text (default: the project's own)")
      ->type_name("FILE");
  verb->add_option("--fps", c.options.max_fps, "faster motions are resampled to this")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 1000.0));
  verb->add_option("--json", c.json, "the report")->type_name("FILE");
  verb->add_option("--sheet", c.sheet, "stick figures of every clip, .png")->type_name("FILE");
  verb->add_option("--instants", c.picture.instants, "of a clip on the sheet")
      ->capture_default_str()
      ->check(CLI::Range(1, 200));
  verb->add_option("--columns", c.picture.columns, "of clips on the sheet")
      ->capture_default_str()
      ->check(CLI::Range(1, 20));
  verb->callback(
      [request, action] { *action = [request] { std::cout << ToText(SurveyMotions(*request, CommandCallbacks())); }; });
}

}  // namespace bodyloom
