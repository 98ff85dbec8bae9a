// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/card.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "neural/motion/motion_card.h"

namespace bodyloom {

void AddCard(CLI::App& app, std::function<void()>* action) {
  CLI::App* verb = app.add_subcommand("card", "Prints a system's networks: names, shapes, parameters, multiply-adds");
  struct Request {
    std::string system = "motion", profile = "cpu";
  };
  auto request = std::make_shared<Request>();
  verb->add_option("system", request->system, "Which renderer")
      ->check(CLI::IsMember({"motion"}))
      ->capture_default_str();
  verb->add_option("--profile", request->profile, "Sizes of the networks")
      ->check(CLI::IsMember({"paper", "cpu", "tiny"}))
      ->capture_default_str();
  verb->callback([request, action] {
    *action = [request] {
      MotionConfig config;
      config.profile = MotionProfileNamed(request->profile);
      std::cout << MotionCard(config);
    };
  });
}

}  // namespace bodyloom
