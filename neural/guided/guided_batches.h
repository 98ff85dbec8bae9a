// SPDX-License-Identifier: Apache-2.0
/// The batches of a training run, prefetched by a thread of their own. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <cstdint>

#include "bodyloom/geometry/base/prefetcher.h"
#include "bodyloom/neural/guided/guided_config.h"
#include "bodyloom/neural/guided/guided_model.h"
#include "bodyloom/neural/people/photo_frame.h"
#include "bodyloom/neural/people/texel_neighbours.h"

namespace bodyloom {

struct GuidedBatch {
  GuidedTensors source;  ///< whole windows
  GuidedTensors target;  ///< cropped to the box, as the renderer will crop
  GuidedPseudo pseudo;   ///< of the target
  CodeBox box;
};

/// Of step `step` (neural/guided/guided_plan.h). The box is that of all targets, grown by `reach` pixels.
/// `neighbours`: of the people's atlas, for configurations with contour hints.
GuidedBatch MakeGuidedBatch(const PhotoSource& people, const GuidedConfig& config, uint64_t seed, int64_t step,
                            int batch, int reach, const TexelNeighbours* neighbours = nullptr);

}  // namespace bodyloom
