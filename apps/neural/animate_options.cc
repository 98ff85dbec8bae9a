// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/animate_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

namespace bodyloom {

void AddLikenessWeights(CLI::App* verb, std::string* weights, const char* what) {
  verb->add_option("--weights", *weights,
                   std::string("Folder with trained weights (.safetensors, .pth): ") + what +
                       "; without them random features measure, which compare with nothing else")
      ->type_name("DIR");
}

void AddDeviceOptions(CLI::App* verb, AnimationRequest* request) {
  verb->add_option("--threads", request->threads, "0: all cores")->check(CLI::NonNegativeNumber);
  verb->add_option("--device", request->device, "Where the networks run")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str();
}

void PrintFramesWithoutFit(const AnimationSummary& summary) {
  if (summary.frames_without_fit > 0) {
    std::printf("%d frames have no fit and show the background\n", summary.frames_without_fit);
  }
}

}  // namespace bodyloom
