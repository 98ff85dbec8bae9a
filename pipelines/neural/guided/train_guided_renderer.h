// SPDX-License-Identifier: Apache-2.0
/// Trains the pose-guided renderer from files; implements `bodyloom train guided`.
#pragma once

#include "geometry/base/callbacks.h"
#include "neural/guided/train_guided.h"
#include "pipelines/neural/photo/people_data.h"

namespace bodyloom {

/// Request; uses vgg16, alexnet, lpips_alex and vgg19 of `weights`.
using TrainGuidedRendererRequest = TrainOnPeopleRequest<TrainGuidedOptions>;

/// Trains or resumes a run. A stopped run ends with its checkpoint and status TrainingStatus::kStopped. Throws
/// RequestError when a run unexpectedly exists or is missing, std::runtime_error for files that cannot be used and when
/// a loss is not finite. Previews have one row per image: source, known part of the target, result and truth, then
/// known, generated and true labels.
TrainGuidedSummary TrainGuidedRenderer(const TrainGuidedRendererRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
