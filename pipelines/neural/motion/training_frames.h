// SPDX-License-Identifier: Apache-2.0
/// Training and validation frames of a clip for the motion-dependent renderer.
#pragma once

#include <vector>

#include "data_tools/descriptors/person_frames.h"
#include "neural/motion/rollout_plan.h"
#include "pipelines/neural/motion/motion_data.h"

namespace bodyloom {

struct TrainingFramesRequest {
  std::vector<FrameRange> train;  ///< empty: all that are not for validation
  std::vector<FrameRange>
      validate;      ///< of the clip for validation, where there is one; empty: all of that, or the last
                     ///< fifth of the one clip
  double share = 1;  ///< of the training frames that is used, in stretches of 32
};

struct TrainingFrames {
  std::vector<FrameRange> train, validation;
};

/// Without frames that have no result, and cut where the clock jumps: a recurrent network must not be led across.
/// `validation`: the clip that is for validation alone; nullptr: there is none. Throws RequestError for ranges that the
/// clips do not have.
TrainingFrames ChooseFrames(const TrainingFramesRequest& request, const PersonFrames& frames,
                            const PersonFrames* validation);

/// Pixels that clothes reach beyond the body in frames spread over the ranges (neural/motion/motion_frame.h); 0
/// without labels.
int ReachOf(MotionData* data, const std::vector<FrameRange>& ranges);

}  // namespace bodyloom
