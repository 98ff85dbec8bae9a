// SPDX-License-Identifier: Apache-2.0
/// Trains the pose-guided renderer from files: what `bodyloom train guided` does.
#pragma once

#include <string>

#include "geometry/base/callbacks.h"
#include "neural/guided/train_guided.h"

namespace bodyloom {

struct TrainGuidedRendererRequest {
  std::string data;  ///< a multi-person dataset, or a single-person dataset (one person, all for training)
  std::string body;  ///< the people's body; empty: the built-in body
  std::string out;   ///< folder of the run: config.json, checkpoint.bin, metrics.csv, previews
  std::string
      weights;  ///< folder with vgg16, alexnet, lpips_alex, vgg19 (pipelines/neural/weights_folder.h); empty: none
  /// Configuration and numbers; what follows from files (people, reach, weights, run_dir) is filled in by the job.
  TrainGuidedOptions options;
};

struct TrainGuidedRendererSummary : TrainGuidedSummary {
  std::string checkpoint;  ///< the file written, and others beside it
};

/// A run that was stopped ends with its checkpoint and says so (TrainingStatus::kStopped). Throws RequestError for a
/// run that is or is not there, std::runtime_error for files that cannot be used and when a loss is not finite.
TrainGuidedRendererSummary TrainGuidedRenderer(const TrainGuidedRendererRequest& request,
                                               const PipelineCallbacks& callbacks);

}  // namespace bodyloom
