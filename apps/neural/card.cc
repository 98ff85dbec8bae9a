// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/neural/neural_verbs.h"
#include "apps/neural/training_options.h"
#include "pipelines/neural/weights_folder.h"

namespace bodyloom {
namespace {

NeuralRenderer RendererNamed(const std::string& system) {
  if (system == "photo") return NeuralRenderer::kPhoto;
  return system == "guided" ? NeuralRenderer::kGuided : NeuralRenderer::kMotion;
}

}  // namespace

void AddCard(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("card", "Prints a system's networks: names, shapes, parameters, multiply-adds");
  struct Parsed {
    std::string system = "motion", profile = "cpu";
  };
  auto parsed = std::make_shared<Parsed>();
  verb->add_option("system", parsed->system, "Which renderer")
      ->check(CLI::IsMember({"motion", "photo", "guided"}))
      ->capture_default_str();
  AddProfileOption(verb, &parsed->profile);
  verb->callback([parsed, action] {
    *action = [parsed] { std::cout << NetworkCard(RendererNamed(parsed->system), parsed->profile); };
  });
}

}  // namespace bodyloom
