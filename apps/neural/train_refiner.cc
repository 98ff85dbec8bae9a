// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include "apps/command_callbacks.h"
#include "apps/neural/neural_verbs.h"
#include "apps/neural/picture_training_options.h"
#include "apps/neural/training_report.h"
#include "bodyloom/pipelines/neural/refiner/train_person_refiner.h"

namespace bodyloom {
namespace {

void RunTrainRefiner(const TrainPersonRefinerRequest& request) {
  const TrainPersonRefinerSummary summary = TrainPersonRefiner(request, CommandCallbacks());
  if (request.weights.empty()) PrintRandomFeatures("perceptual loss", "VGG-16");
  PrintStep(summary, request.options.steps);
  if (summary.test_pictures > 0) {
    std::printf("%zu pictures of people kept for testing: PSNR %.2f dB as drawn, %.2f dB refined\n",
                summary.test_pictures, summary.drawn_psnr_db, summary.refined_psnr_db);
    std::fflush(stdout);
  }
  std::cout << "wrote " << summary.weights << " (" << summary.num_parameters << " numbers)\n";
  RequireNotStopped(summary, request.out);
}

}  // namespace

void AddTrainRefiner(CLI::App& train, Action* action) {
  CLI::App* verb = train.add_subcommand(
      "refiner", "Trains the network that refines pictures of people made from photos (needs LibTorch)");
  auto request = std::make_shared<TrainPersonRefinerRequest>();
  TrainRefinerOptions& options = request->options;
  verb->add_option("--data", request->data, "A multi-person dataset (bodyloom synth-people)")->required();
  verb->add_option("--out", request->out, "Folder of the run: config.json, checkpoint.bin, metrics.csv, refiner.npz")
      ->required();
  verb->add_option("--body", request->body, "The people's body (default: the built-in body)");
  verb->add_option("--size", request->size, "Pixels of the windows that people are drawn in")
      ->check(CLI::Range(64, 2048))
      ->capture_default_str();
  verb->add_option("--texture-size", request->texture_size, "Texels a side")
      ->check(CLI::Range(64, 8192))
      ->capture_default_str();
  verb->add_option("--weights", request->weights, "Folder with trained weights: vgg16 (.safetensors, .pth)");
  verb->add_flag("--outline", options.moves_outline,
                 "Refines the outline too, not colours alone: hair and hems stand off, wide clothes may become narrow");
  verb->add_option("--alpha-weight", options.alpha_weight, "With --outline: of the outline beside the picture")
      ->capture_default_str();
  verb->add_option("--perceptual-weight", options.perceptual_weight, "Of VGG's features beside the picture")
      ->capture_default_str();
  AddPictureTrainingOptions(verb, &options, &request->body_error_px, "Bodies of every other person",
                            "Of weights, crops and photos");
  verb->footer(
      "Example:\n  bodyloom synth-people --motions motions --size 512 --out people\n"
      "  bodyloom train refiner --data people --out run\n"
      "  bodyloom animate person --image me.jpg --refiner run/refiner.npz --track dance.npz --out me.mp4");
  verb->callback([request, action] { *action = [request] { RunTrainRefiner(*request); }; });
}

}  // namespace bodyloom
