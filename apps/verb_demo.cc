// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/demo/run_demo.h"

namespace bodyloom {

void AddDemoVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("demo", "Everything at once: a clip is made, tracked, evaluated and shown");
  verb->footer(std::string("Writes summary.html, overlay.mp4, track.npz and what they came from into one folder.\n"
                           "Example:\n  bodyloom demo --out demo\n\n") +
               kExitCodeHelp);
  auto request = std::make_shared<DemoRequest>();
  DemoRequest& c = *request;
  verb->add_option("--out", c.out, "folder")->capture_default_str()->type_name("DIR");
  verb->add_option("--frames", c.num_frames, "only the first N frames (0: all 6 seconds)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--seed", c.seed, "of the faults")->capture_default_str();
  verb->add_option("--threads", c.num_threads, "0: all cores")->check(CLI::NonNegativeNumber)->capture_default_str();
  verb->callback(
      [request, action] { *action = [request] { std::cout << ToText(RunDemo(*request, CommandCallbacks())); }; });
}

}  // namespace bodyloom
