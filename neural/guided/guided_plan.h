// SPDX-License-Identifier: Apache-2.0
/// The plan of a training step, what it looks at and what it hides: functions of (seed, step, place in the batch)
/// alone.
///
/// A sample is two pictures of one person, of different views and poses where there are such (the same section). Of the
/// target only what lies on the bare body is known, less random patches:
/// rectangles, and now and then whole charts of the surface, as a photo from one side leaves them out (Yoon et al.,
/// CVPR 2021, Section 3.1: "removing the outside region of the body silhouette … and further removing some parts using
/// random binary patches"; numbers and sizes are this project's choice).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bodyloom/neural/people/photo_frame.h"

namespace bodyloom {

struct GuidedSample {
  int person = 0, source = 0, target = 0;  ///< source ≠ target where the person has two pictures
};

/// Of people with at least one picture each; throws std::invalid_argument otherwise.
GuidedSample GuidedSampleOf(uint64_t seed, int64_t step, int place, const PhotoSource& people);

/// Charts of size × size pixels → 1 where the target is known.
std::vector<uint8_t> KnownPixels(uint64_t seed, int64_t step, int place, int size, std::span<const uint8_t> charts);

}  // namespace bodyloom
