// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/neural/neural_verbs.h"
#include "apps/neural/training_options.h"
#include "apps/progress.h"
#include "pipelines/neural/lifter/train_lifter_network.h"
#include "pipelines/report_text.h"

namespace bodyloom {
namespace {

struct TrainLifterArguments {
  TrainLifterNetworkRequest request;
  std::string optimizer = "muon";
};

void RunTrainLifter(const TrainLifterArguments& parsed) {
  TrainLifterNetworkRequest request = parsed.request;
  request.options.muon = parsed.optimizer == "muon";
  const TrainLifterNetworkSummary summary = TrainLifterNetwork(request, CommandCallbacks());
  std::cout << "step " << summary.steps << " of " << request.options.steps << " in " << ClockText(summary.seconds)
            << "; validation: mean distance " << summary.validation_distance
            << " of torso + leg, with the best of each limb's hypotheses " << summary.validation_best_distance
            << "\nwrote " << summary.weights << " (" << summary.num_parameters << " numbers)\n";
  RequireNotStopped(summary, request.out);
}

}  // namespace

void AddTrainLifter(CLI::App& train, Action* action) {
  CLI::App* verb = train.add_subcommand("lifter", "Trains the network that lifts 2D joints to 3D from recorded motion");
  auto parsed = std::make_shared<TrainLifterArguments>();
  TrainLifterNetworkRequest& request = parsed->request;
  TrainLifterOptions& options = request.options;
  verb->add_option("--motions", request.motions, "Motion files, or folders of them (BVH, ASF/AMC, AMASS, …)")
      ->required();
  verb->add_option("--out", request.out, "Folder of the run: config.json, metrics.csv, checkpoint.bin, lifter.npz")
      ->required();
  verb->add_option("--split", request.split, "Which clips are for training (default: the project's own list)");
  verb->add_option("--share", request.share, "Of the training motion that is used")
      ->check(CLI::Range(0.001, 1.0))
      ->capture_default_str();
  AddStepOptions(verb, &options.steps, &options.batch, &options.learning_rate, "Windows in a batch");
  verb->add_option("--channels", options.width, "Width of the network")->capture_default_str();
  verb->add_option("--optimizer", parsed->optimizer, "For the blocks' matrices")
      ->check(CLI::IsMember({"muon", "adamw"}))
      ->capture_default_str();
  verb->add_option("--init-from", request.init_from, "Weights to begin with (lifter.npz), of as many channels")
      ->check(CLI::ExistingFile);
  verb->add_option("--seed", options.seed, "Of the weights and the windows")->capture_default_str();
  verb->add_option("--threads", options.num_threads, "0: all cores")->capture_default_str();
  verb->add_flag("--resume", options.resume, "Go on with the run in --out");
  verb->footer(
      "Example:\n  bodyloom train lifter --motions motion/ aistpp/motions --out run --steps 12000\n"
      "Then: bodyloom track --lifter run/lifter.npz ...");
  verb->callback([parsed, action] { *action = [parsed] { RunTrainLifter(*parsed); }; });
}

}  // namespace bodyloom
