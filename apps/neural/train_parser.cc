// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "apps/neural/neural_verbs.h"
#include "apps/neural/training_options.h"
#include "apps/progress.h"
#include "apps/usage_error.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "pipelines/neural/parser/train_clothes_parser.h"

namespace bodyloom {
namespace {

void PrintOverlap(const TrainClothesParserSummary& summary) {
  std::printf("%zu images of people kept for testing, intersection over union inside the mask:\n", summary.test_images);
  std::printf("  %-8s %8s %22s\n", "", "parsed", "nearest of the body");
  std::printf("  %-8s %8.3f %22.3f\n", "mean", summary.mean_iou, summary.body_mean_iou);
  for (size_t k = 0; k < summary.iou.size(); ++k) {
    if (std::isnan(summary.iou[k])) continue;
    std::printf("  %-8s %8.3f %22.3f\n", kPersonLabelNames[k + 1], summary.iou[k], summary.body_iou[k]);
  }
  std::fflush(stdout);
}

void RunTrainParser(const TrainClothesParserRequest& request) {
  const TrainClothesParserSummary summary = TrainClothesParser(request, CommandCallbacks());
  PrintStep(summary, request.options.steps);
  if (summary.test_images > 0) PrintOverlap(summary);
  std::cout << "wrote " << summary.weights << " (" << summary.num_parameters << " numbers)\n";
  RequireNotStopped(summary, request.out);
}

}  // namespace

void AddTrainParser(CLI::App& train, Action* action) {
  CLI::App* verb =
      train.add_subcommand("parser", "Trains the network that tells clothes, hair and skin apart (needs LibTorch)");
  auto request = std::make_shared<TrainClothesParserRequest>();
  verb->add_option("--data", request->data, "A multi-person dataset (bodyloom synth-people)")->required();
  verb->add_option("--out", request->out, "Folder of the run: config.json, checkpoint.bin, metrics.csv, parser.npz")
      ->required();
  verb->add_option("--body", request->body, BodyHelp("The people's body"));
  verb->add_option("--size", request->size, "Pixels of the windows that people are shown in")
      ->check(CLI::Range(64, 2048))
      ->capture_default_str();
  TrainParserOptions& options = request->options;
  AddStepOptions(verb, &options.steps, &options.batch, &options.learning_rate, "Crops in a batch");
  verb->add_option("--crop", options.crop, "Pixels of a crop's side, a multiple of 16")->capture_default_str();
  verb->add_option("--light-strength", options.light_strength, "Of the change of colours that each crop gets; 0: none")
      ->capture_default_str();
  verb->add_option("--body-error", request->body_error_px,
                   "Bodies are off by up to this, as fitted ones are: mean distance of projected vertices, pixels in a "
                   "image whose longer side has 512")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
  AddTrainingOptions(verb, &options, "Of weights and crops");
  verb->footer(
      "Example:\n  bodyloom synth-people --clothes everyday --motions motions --size 512 --out people\n"
      "  bodyloom train parser --data people --out run\n"
      "  bodyloom parse me.jpg --weights run/parser.npz --out labels.png");
  verb->callback([request, action] { *action = [request] { RunTrainParser(*request); }; });
}

}  // namespace bodyloom
