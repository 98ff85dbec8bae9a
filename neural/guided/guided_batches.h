// SPDX-License-Identifier: Apache-2.0
/// Batches of a training run, prefetched by a separate thread. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/base/prefetcher.h"
#include "neural/guided/guided_config.h"
#include "neural/guided/guided_model.h"
#include "render/texture/complete/texel_neighbours.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

struct GuidedBatch {
  GuidedTensors source;  ///< whole windows
  GuidedTensors target;  ///< each cropped to its own box, as in rendering, all of one size
  GuidedPseudo pseudo;   ///< of the target
  std::vector<CodeBox> boxes;
  /// The whole box, for tensors that are cropped already: targets, and the source's codes by CroppedEach.
  [[nodiscard]] CodeBox Whole() const { return {0, 0, boxes.at(0).width, boxes.at(0).height}; }
};

/// Creates the batch of step `step`. The boxes are grown by `reach` pixels. `neighbours`: of the people's atlas, for
/// configurations with contour hints.
GuidedBatch MakeGuidedBatch(const PhotoSource& people, const GuidedConfig& config, uint64_t seed, int64_t step,
                            int batch, int reach, const TexelNeighbours* neighbours = nullptr);

// Samples of a training step and their masks: functions of (seed, step, place in the batch) alone.
//
// A sample is two images of one person, of different views and poses if available (the same section). The known part of
// the target is the bare body minus random patches: rectangles, and sometimes whole charts of the surface, as they are
// missing in a photo from one side (Yoon et al., CVPR 2021, Section 3.1: "removing the outside region of the body
// silhouette … and further removing some parts using random binary patches"; numbers and sizes are this project's
// choice).

struct GuidedSample {
  int person = 0, source = 0, target = 0;  ///< source ≠ target if the person has two images
};

/// Draws a sample. Each person must have at least one image; throws std::invalid_argument otherwise.
GuidedSample GuidedSampleOf(uint64_t seed, int64_t step, int place, const PhotoSource& people);

/// Mask of size × size pixels from their charts: 1 where the target is known.
std::vector<uint8_t> KnownPixels(uint64_t seed, int64_t step, int place, int size, std::span<const uint8_t> charts);

}  // namespace bodyloom
