// SPDX-License-Identifier: Apache-2.0
/// The batches of a training run, prefetched by a thread of their own. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <vector>

#include "bodyloom/geometry/base/prefetcher.h"
#include "bodyloom/neural/guided/guided_config.h"
#include "bodyloom/neural/guided/guided_model.h"
#include "bodyloom/neural/people/photo_frame.h"
#include "bodyloom/neural/people/texel_neighbours.h"

namespace bodyloom {

struct GuidedBatch {
  GuidedTensors source;  ///< whole windows
  GuidedTensors target;  ///< each cropped to its own box, as the renderer will crop, all of one size
  GuidedPseudo pseudo;   ///< of the target
  std::vector<CodeBox> boxes;
  /// Of what is cropped already, all: targets, and the source's codes by CroppedEach.
  [[nodiscard]] CodeBox Whole() const { return {0, 0, boxes.at(0).width, boxes.at(0).height}; }
};

/// Of step `step` (neural/guided/guided_plan.h). The boxes are grown by `reach` pixels.
/// `neighbours`: of the people's atlas, for configurations with contour hints.
GuidedBatch MakeGuidedBatch(const PhotoSource& people, const GuidedConfig& config, uint64_t seed, int64_t step,
                            int batch, int reach, const TexelNeighbours* neighbours = nullptr);

}  // namespace bodyloom
