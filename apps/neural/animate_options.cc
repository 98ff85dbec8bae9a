// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/animate_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "geometry/base/check.h"

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

std::string CommandLine(const AnimateMotionRequest& request) {
  std::string line = "bodyloom animate motion";
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) line += std::string(" ") + option + " " + value;
  };
  add("--run", request.run), add("--track", request.track), add("--data", request.data), add("--body", request.body);
  add("--iuv", request.iuv);
  add("--background", request.background), add("--relight", request.relight);
  line += request.true_normals ? " --true-normals" : "";
  if (request.speed != 1) add("--speed", Concatenate(request.speed));
  if (request.shape_of_track) add("--shape", "track");
  add("--freeze", request.freeze);
  if (request.warmup != AnimateMotionRequest().warmup) add("--warmup", Concatenate(request.warmup));
  line += request.whole_window ? " --whole-window" : "";
  line += request.without_past ? " --without-past" : "";
  line += request.full_size ? " --full-size" : "";
  add("--out", request.out), add("--set", request.set);
  return line;
}

}  // namespace bodyloom
