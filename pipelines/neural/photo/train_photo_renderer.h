// SPDX-License-Identifier: Apache-2.0
/// Trains the one-photo renderer from files: what `bodyloom train photo` does.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "neural/photo/train_photo.h"
#include "render/image/image.h"

namespace bodyloom {

struct TrainPhotoRendererRequest {
  std::string data;     ///< a multi-person dataset, or a single-person dataset (one person, all for training)
  std::string body;     ///< the people's body; empty: the built-in body
  std::string out;      ///< folder of the run: config.json, checkpoint.bin, metrics.csv, previews
  std::string weights;  ///< folder with vgg19, sphereface, alexnet, lpips_alex (pipelines/neural/weights_folder.h);
                        ///< empty: none
  /// Configuration and numbers; what follows from files (people, reach, weights, run_dir) is filled in by the job.
  TrainPhotoOptions options;
};

struct TrainPhotoRendererSummary : TrainPhotoSummary {
  std::string checkpoint;  ///< the file written, and others beside it
};

/// A run that was stopped ends with its checkpoint and says so (TrainingStatus::kStopped). Throws RequestError for a
/// run that is or is not there, std::runtime_error for files that cannot be used and when a loss is not finite.
TrainPhotoRendererSummary TrainPhotoRenderer(const TrainPhotoRendererRequest& request,
                                             const PipelineCallbacks& callbacks);

// Pictures to judge a run of the one-photo renderer by.

/// A row a pair: the source picture, what it shows of the texture, the completed texture, the true target, the result.
Image PhotoPreviewSheet(const std::vector<PhotoPreview>& previews);

}  // namespace bodyloom
