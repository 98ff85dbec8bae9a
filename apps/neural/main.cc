// SPDX-License-Identifier: Apache-2.0
// The command `bodyloom-neural`: the verbs that need LibTorch. `bodyloom neural VERB`, `bodyloom train …` and
// `bodyloom animate …` start it, `bodyloom metrics --lpips` and `bodyloom detect --dense-model` too.
#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <string>
#include <string_view>

#include "apps/neural/neural_verbs.h"
#include "apps/progress.h"
#include "apps/usage_error.h"
#include "neural/base/runtime.h"
#include "pipelines/neural/densepose_detector.h"

namespace {

/// Name of this program for users; most of its verbs are also available as `bodyloom VERB`.
std::string CalledAs(int argc, char** argv) {
  const std::string_view verb = argc > 1 ? argv[1] : "";
  return verb == "train" || verb == "animate" || verb == "metrics" || verb == "detect" ? "bodyloom" : "bodyloom neural";
}

bodyloom::ChartDetector DenseDetector(const std::string& model, const std::string& device, const std::string& colours) {
  using bodyloom::DensePoseColours;
  return bodyloom::DensePoseDetector({model, device,
                                      colours.empty()    ? DensePoseColours::kOfForm
                                      : colours == "rgb" ? DensePoseColours::kRgb
                                                         : DensePoseColours::kBgr});
}

}  // namespace

int main(int argc, char** argv) {
  bodyloom::InstallSignalHandlers();
  const std::string name = CalledAs(argc, argv);
  CLI::App app("The verbs of bodyloom that need LibTorch.", name);
  app.require_subcommand(1);
  app.footer(bodyloom::kExitCodeHelp);
  std::function<void()> action;
  int num_threads = 0;
  CLI::App* doctor = app.add_subcommand("doctor", "Prints what LibTorch runs on, and what makes it slow");
  doctor->add_option("--threads", num_threads, "threads inside one operation (0: all cores)")
      ->check(CLI::NonNegativeNumber);
  doctor->callback([&] { action = [&] { std::cout << bodyloom::ToText(bodyloom::StartNeuralRuntime(num_threads)); }; });
  CLI::App* train = app.add_subcommand("train", "Trains a network");
  train->require_subcommand(1);
  bodyloom::AddTrainLifter(*train, &action);
  bodyloom::AddTrainMotion(*train, &action);
  bodyloom::AddTrainPhoto(*train, &action);
  bodyloom::AddTrainGuided(*train, &action);
  bodyloom::AddTrainParser(*train, &action);
  CLI::App* animate = app.add_subcommand("animate", "Renders a person with a trained network");
  animate->require_subcommand(1);
  bodyloom::AddAnimateMotion(*animate, &action);
  bodyloom::AddAnimatePhoto(*animate, &action);
  bodyloom::AddAnimateGuided(*animate, &action);
  bodyloom::AddScorePerson(*animate, &action);
  bodyloom::AddCard(app, &action);
  bodyloom::AddMetricsVerb(app, &action, {}, bodyloom::LikenessMetrics);
  bodyloom::AddDetectVerb(app, &action, {}, DenseDetector);
  return bodyloom::RunParsed(&app, name, argc, argv, action);
}
