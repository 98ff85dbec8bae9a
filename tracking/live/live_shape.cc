// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/live/live_shape.h"

#include "bodyloom/tracking/initialise/bone_ratio_shape.h"

namespace bodyloom {

void LiveShape::Refine(const LiveSetup& setup, LiveWindow* window) {
  const int num_betas = setup.layout.num_betas;
  const KeypointSequence& sample = window->history().Sample();
  if (num_betas == 0 || sample.num_frames() == 0 || window->frames_of_clip() < next_frames_) return;
  next_frames_ *= 2;
  window->lag().problem().shape_prior.mean =
      EstimateShape(sample, window->PinholeNow(), *setup.input.body, num_betas, setup.options.solve.hypotheses);
}

}  // namespace bodyloom
