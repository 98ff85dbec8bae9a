// SPDX-License-Identifier: Apache-2.0
/// Trains the motion-dependent renderer of one person from files; implements `bodyloom train motion`.
#pragma once

#include <string>
#include <vector>

#include "data_tools/descriptors/person_frames.h"
#include "geometry/base/callbacks.h"
#include "neural/motion/rollout_plan.h"
#include "neural/motion/train_motion.h"
#include "pipelines/neural/motion/motion_data.h"

namespace bodyloom {

// Selects training and validation frames of a clip for the motion-dependent renderer.

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

struct TrainMotionRendererRequest {
  MotionDataRequest data;
  std::string validate_data;  ///< another dataset of the same person, in another motion; empty: the same clip
  std::string cameras, view;  ///< the camera's pose where data.motion is in world axes; empty: a level camera
  TrainingFramesRequest frames;
  std::string out;      ///< folder of the run: config.json, checkpoint.bin, metrics.csv, previews
  std::string weights;  ///< folder with vgg16, alexnet, lpips_alex (pipelines/neural/weights_folder.h); empty: none
  bool whole_window =
      false;  ///< networks use the whole window, not only the body's surroundings within the reach of clothes
  /// Profile, parts and hyperparameters; fields that depend on files (frames, channels, reach, run_dir) are set by the
  /// job.
  TrainMotionOptions options;
};

/// Trains or resumes a run. A stopped run ends with its checkpoint and status TrainingStatus::kStopped. Throws
/// RequestError for a request that contradicts itself or the data, std::runtime_error for files that cannot be used and
/// when a loss is not finite. Previews have one row per frame: truth and result of the image, then of labels and
/// normals if there are any.
TrainMotionSummary TrainMotionRenderer(const TrainMotionRendererRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
