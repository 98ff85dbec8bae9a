// SPDX-License-Identifier: Apache-2.0
/// Trains the pose-guided renderer from files: what `bodyloom train guided` does.
#pragma once

#include "geometry/base/callbacks.h"
#include "neural/guided/train_guided.h"
#include "pipelines/neural/photo/people_data.h"

namespace bodyloom {

/// Of `weights`: vgg16, alexnet, lpips_alex, vgg19.
using TrainGuidedRendererRequest = TrainOnPeopleRequest<TrainGuidedOptions>;

/// A run that was stopped ends with its checkpoint and says so (TrainingStatus::kStopped). Throws RequestError for a
/// run that is or is not there, std::runtime_error for files that cannot be used and when a loss is not finite.
/// Previews, a row a picture: source, what is known of the target, result and truth, then labels known, made and true.
TrainGuidedSummary TrainGuidedRenderer(const TrainGuidedRendererRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
