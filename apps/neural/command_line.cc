// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/command_line.h"

#include "geometry/base/check.h"

namespace bodyloom {

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
