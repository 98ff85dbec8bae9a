// SPDX-License-Identifier: Apache-2.0
/// A turning person with its maps, small enough for fast correlation.
#pragma once

#include "benchmarks/accuracy/turning_person.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/descriptors/person_frames.h"

namespace bodyloom {

inline TurningPerson ShortTurningClip(double variation, double amplitude_deg = 60) {
  TurningPersonOptions options;
  options.cycles = 3;
  options.period_s = 1.6;
  options.fps = 20;
  options.image_size = 128;
  options.variation = variation;
  options.amplitude_deg = amplitude_deg;
  return MakeTurningPerson(BuiltinBody(), options);
}

inline PersonFramesOptions SmallFrames(int window_side) {
  PersonFramesOptions options;
  options.uv_size = 24;
  options.window.max_side = window_side;
  return options;
}

}  // namespace bodyloom
