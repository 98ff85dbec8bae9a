// SPDX-License-Identifier: Apache-2.0
/// The fuzzers' functions for what the neural verbs read beside weights and pictures: a run's config.json and the light
/// that shall be.
#pragma once

#include <cmath>
#include <string>

#include "bodyloom/pipelines/people/relight_frames.h"
#include "bodyloom/pipelines/runs/guided_run.h"
#include "bodyloom/pipelines/runs/motion_run.h"
#include "bodyloom/pipelines/runs/photo_run.h"
#include "tests/fuzz/fuzz_file_targets.h"

namespace bodyloom::fuzz {

/// The run of any of the three renderers.
inline bool AcceptsRunConfig(const std::string& bytes) {
  Folder().Write("run/config.json", bytes);
  const std::string folder = Folder().path() + "/run";
  std::string why;
  const bool motion = Accepts([&] {
    const MotionRun run = ReadMotionRun(folder);
    if (!run.config.IsValid(&why)) throw std::logic_error(why);
    if (!std::isfinite(run.fps) || !std::isfinite(run.pixels_per_metre)) throw std::logic_error("not finite");
  });
  const bool photo = Accepts([&] {
    if (!ReadPhotoRun(folder).config.IsValid(&why)) throw std::logic_error(why);
  });
  const bool guided = Accepts([&] {
    if (!ReadGuidedRun(folder).config.IsValid(&why)) throw std::logic_error(why);
  });
  return motion || photo || guided;
}

inline bool AcceptsRelight(const std::string& bytes) {
  const std::string path = Folder().Write("light.json", bytes);
  return Accepts([&] {
    if (!ReadRelight(path).light.allFinite()) throw std::logic_error("light that is not finite");
  });
}

}  // namespace bodyloom::fuzz
