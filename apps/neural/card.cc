// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/card.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/neural/training_options.h"
#include "bodyloom/neural/guided/guided_card.h"
#include "bodyloom/neural/motion/motion_card.h"
#include "bodyloom/neural/photo/photo_card.h"

namespace bodyloom {
namespace {

std::string CardOf(const std::string& system, const std::string& profile) {
  if (system == "photo") return PhotoCard({PhotoProfileNamed(profile)});
  if (system == "animate") return GuidedCard({GuidedProfileNamed(profile)});
  MotionConfig config;
  config.profile = MotionProfileNamed(profile);
  return MotionCard(config);
}

}  // namespace

void AddCard(CLI::App& app, std::function<void()>* action) {
  CLI::App* verb = app.add_subcommand("card", "Prints a system's networks: names, shapes, parameters, multiply-adds");
  struct Request {
    std::string system = "motion", profile = "cpu";
  };
  auto request = std::make_shared<Request>();
  verb->add_option("system", request->system, "Which renderer")
      ->check(CLI::IsMember({"motion", "photo", "animate"}))
      ->capture_default_str();
  AddProfileOption(verb, &request->profile);
  verb->callback(
      [request, action] { *action = [request] { std::cout << CardOf(request->system, request->profile); }; });
}

}  // namespace bodyloom
