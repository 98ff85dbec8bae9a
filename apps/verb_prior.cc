// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "apps/verbs.h"
#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/formats/files_below.h"
#include "bodyloom/data_tools/learned/pose_prior_io.h"
#include "bodyloom/data_tools/learned/pose_prior_learning.h"
#include "bodyloom/data_tools/motion/load_motion.h"

namespace bodyloom {
namespace {

struct PriorRequest {
  std::string motions, out;
  LearnPosePriorOptions options;
};

void Run(const PriorRequest& request) {
  std::vector<Motion> motions;
  double seconds = 0;
  for (const std::string& file : FilesBelow(request.motions)) {
    try {
      Motion motion = LoadMotion(file);
      seconds += motion.timestamps.back() - motion.timestamps.front();
      motions.push_back(std::move(motion));
    } catch (const std::runtime_error& error) {
      std::cerr << "left out: " << error.what() << "\n";  // licences, skeletons and readmes lie among the motions
    }
  }
  const PosePrior prior = LearnPosePrior(motions, BuiltinBody(), request.options);
  WritePosePrior(request.out, prior);
  std::cout << "learned from " << motions.size() << " motions, " << seconds / 60
            << " minutes: " << prior.num_components() << " components over " << prior.joints.size() << " joints\nwrote "
            << request.out << "\n";
}

}  // namespace

void AddPriorVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("prior", "Learns a pose prior from a folder of motions");
  auto request = std::make_shared<PriorRequest>();
  LearnPosePriorOptions& options = request->options;
  verb->add_option("--motions", request->motions, "Motion file, or a folder of them (BVH, ASF/AMC, AMASS, …)")
      ->required();
  verb->add_option("--out", request->out, "The prior, .npz")->required();
  verb->add_option("--components", options.num_components, "Gaussians in the mixture")->capture_default_str();
  verb->add_option("--seed", options.seed, "Of the mixture's start")->capture_default_str();
  verb->footer(
      "Example, which makes the built-in prior again:\n"
      "  bodyloom prior --motions motion/ --out assets/prior/pose_prior.npz");
  verb->callback([request, action] { *action = [request] { Run(*request); }; });
}

}  // namespace bodyloom
