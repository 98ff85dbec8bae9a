// SPDX-License-Identifier: Apache-2.0
/// Selects training and validation frames of a clip for the motion-dependent renderer.
#pragma once

#include <vector>

#include "data_tools/descriptors/person_frames.h"
#include "neural/motion/rollout_plan.h"
#include "pipelines/neural/motion/motion_data.h"

namespace bodyloom {

struct TrainingFramesRequest {
  std::vector<FrameRange> train;  ///< empty: all frames not used for validation
  std::vector<FrameRange>
      validate;      ///< of the clip for validation, where there is one; empty: all of that, or the last
                     ///< fifth of the one clip
  double share = 1;  ///< share of the training frames that is used, in stretches of 32
};

struct TrainingFrames {
  std::vector<FrameRange> train, validation;
};

/// Ranges without frames that have no result, split at gaps of the clock, over which the recurrent network must not
/// run. `validation`: a separate validation clip; nullptr: none. Throws RequestError for ranges outside the clips.
TrainingFrames ChooseFrames(const TrainingFramesRequest& request, const PersonFrames& frames,
                            const PersonFrames* validation);

/// Maximum distance of clothes from the body in frames spread over the ranges, pixels (neural/motion/motion_frame.h); 0
/// without labels.
int ReachOf(MotionData* data, const std::vector<FrameRange>& ranges);

}  // namespace bodyloom
