// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "apps/progress.h"
#include "apps/verbs.h"
#include "pipelines/prior/learn_prior.h"

namespace bodyloom {
namespace {

void Learn(const LearnPriorRequest& request) {
  const LearnPriorReport report = LearnPrior(request, CommandCallbacks(false, std::cerr));
  std::cout << "learned from " << report.motions << " motions, " << report.minutes << " minutes: " << report.components
            << " components over " << report.joints << " joints\nwrote " << report.out << "\n";
}

}  // namespace

void AddPriorVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("prior", "Learns a pose prior from a folder of motions");
  auto request = std::make_shared<LearnPriorRequest>();
  LearnPosePriorOptions& options = request->options;
  verb->add_option("--motions", request->motions, "Motion file, or a folder of them (BVH, ASF/AMC, AMASS, …)")
      ->required();
  verb->add_option("--out", request->out, "The prior, .npz")->required();
  verb->add_option("--components", options.num_components, "Gaussians in the mixture")->capture_default_str();
  verb->add_option("--seed", options.seed, "Of the mixture's start")->capture_default_str();
  verb->footer(
      "Example, which makes the built-in prior again:\n"
      "  bodyloom prior --motions motion/ --out assets/prior/pose_prior.npz");
  verb->callback([request, action] { *action = [request] { Learn(*request); }; });
}

}  // namespace bodyloom
