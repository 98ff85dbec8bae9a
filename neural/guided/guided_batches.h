// SPDX-License-Identifier: Apache-2.0
/// The batches of a training run, prefetched by a thread of their own. Internal: includes LibTorch.
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
  GuidedTensors target;  ///< each cropped to its own box, as the renderer will crop, all of one size
  GuidedPseudo pseudo;   ///< of the target
  std::vector<CodeBox> boxes;
  /// Of what is cropped already, all: targets, and the source's codes by CroppedEach.
  [[nodiscard]] CodeBox Whole() const { return {0, 0, boxes.at(0).width, boxes.at(0).height}; }
};

/// Of step `step` (neural/guided/guided_batches.h). The boxes are grown by `reach` pixels.
/// `neighbours`: of the people's atlas, for configurations with contour hints.
GuidedBatch MakeGuidedBatch(const PhotoSource& people, const GuidedConfig& config, uint64_t seed, int64_t step,
                            int batch, int reach, const TexelNeighbours* neighbours = nullptr);

// The plan of a training step, what it looks at and what it hides: functions of (seed, step, place in the batch)
// alone.
//
// A sample is two pictures of one person, of different views and poses where there are such (the same section). Of the
// target only what lies on the bare body is known, less random patches:
// rectangles, and now and then whole charts of the surface, as a photo from one side leaves them out (Yoon et al.,
// CVPR 2021, Section 3.1: "removing the outside region of the body silhouette … and further removing some parts using
// random binary patches"; numbers and sizes are this project's choice).

struct GuidedSample {
  int person = 0, source = 0, target = 0;  ///< source ≠ target where the person has two pictures
};

/// Of people with at least one picture each; throws std::invalid_argument otherwise.
GuidedSample GuidedSampleOf(uint64_t seed, int64_t step, int place, const PhotoSource& people);

/// Charts of size × size pixels → 1 where the target is known.
std::vector<uint8_t> KnownPixels(uint64_t seed, int64_t step, int place, int size, std::span<const uint8_t> charts);

}  // namespace bodyloom
