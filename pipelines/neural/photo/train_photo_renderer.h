// SPDX-License-Identifier: Apache-2.0
/// Trains the one-photo renderer from files; implements `bodyloom train photo`.
#pragma once

#include "geometry/base/callbacks.h"
#include "neural/photo/train_photo.h"
#include "pipelines/neural/photo/people_data.h"

namespace bodyloom {

/// Request; uses vgg19, sphereface, alexnet and lpips_alex of `weights`.
using TrainPhotoRendererRequest = TrainOnPeopleRequest<TrainPhotoOptions>;

/// Trains or resumes a run. A stopped run ends with its checkpoint and status TrainingStatus::kStopped. Throws
/// RequestError when a run unexpectedly exists or is missing, std::runtime_error for files that cannot be used and when
/// a loss is not finite. Previews have one row per pair: source image, the part of the texture it shows, completed
/// texture, true target, result.
TrainPhotoSummary TrainPhotoRenderer(const TrainPhotoRendererRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
