// SPDX-License-Identifier: Apache-2.0
/// Trains the motion-dependent renderer of one person from files; implements `bodyloom train motion`.
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
