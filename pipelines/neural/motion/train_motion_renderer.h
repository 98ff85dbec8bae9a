// SPDX-License-Identifier: Apache-2.0
/// Trains the motion-dependent renderer of one person from files: what `bodyloom train motion` does.
#pragma once

#include <string>

#include "geometry/base/callbacks.h"
#include "neural/motion/train_motion.h"
#include "pipelines/neural/motion/motion_data.h"
#include "pipelines/neural/motion/training_frames.h"

namespace bodyloom {

struct TrainMotionRendererRequest {
  MotionDataRequest data;
  std::string validate_data;  ///< another dataset of the same person, in another motion; empty: the same clip
  std::string cameras, view;  ///< the camera's pose where data.motion is in world axes; empty: a level camera
  TrainingFramesRequest frames;
  std::string out;      ///< folder of the run: config.json, checkpoint.bin, metrics.csv, previews
  std::string weights;  ///< folder with vgg16, alexnet, lpips_alex (pipelines/neural/weights_folder.h); empty: none
  bool whole_window =
      false;  ///< the networks look at the whole window, not only as far around the body as clothes reach
  /// Profile, parts and numbers; what follows from files (frames, channels, reach, run_dir) is filled in by the job.
  TrainMotionOptions options;
};

/// A run that was stopped ends with its checkpoint and says so (TrainingStatus::kStopped). Throws RequestError for a
/// request that contradicts itself or the data, std::runtime_error for files that cannot be used and when a loss is not
/// finite. Previews, a row a frame: truth and result of the image, then of labels and normals where there are any.
TrainMotionSummary TrainMotionRenderer(const TrainMotionRendererRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
