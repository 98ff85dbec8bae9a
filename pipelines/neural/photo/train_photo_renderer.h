// SPDX-License-Identifier: Apache-2.0
/// Trains the one-photo renderer from files: what `bodyloom train photo` does.
#pragma once

#include "geometry/base/callbacks.h"
#include "neural/photo/train_photo.h"
#include "pipelines/neural/photo/people_data.h"

namespace bodyloom {

/// Of `weights`: vgg19, sphereface, alexnet, lpips_alex.
using TrainPhotoRendererRequest = TrainOnPeopleRequest<TrainPhotoOptions>;

/// A run that was stopped ends with its checkpoint and says so (TrainingStatus::kStopped). Throws RequestError for a
/// run that is or is not there, std::runtime_error for files that cannot be used and when a loss is not finite.
/// Previews, a row a pair: the source picture, what it shows of the texture, the completed texture, the true target,
/// the result.
TrainPhotoSummary TrainPhotoRenderer(const TrainPhotoRendererRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
