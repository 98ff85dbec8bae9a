// SPDX-License-Identifier: Apache-2.0
/// Draws the training pairs of a step: images of one person in two poses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/texture/photo_frame.h"

namespace bodyloom {

struct PhotoPair {
  int person = 0, source = 0, target = 0;  ///< frames of the person
};

/// The pair at place `place` of step `step`'s batch: a person of `persons` and one of its frames, both uniformly
/// distributed, and a frame of another pose (neural/training/photo_partner.h). Deterministic. Throws
/// std::invalid_argument when there is no person or one has no frames.
PhotoPair DrawPhotoPair(const PhotoSource& people, std::span<const int> persons, uint64_t seed, int64_t step,
                        int place);

/// `per_person` pairs of each person, independent of the seed, for comparison of runs.
std::vector<PhotoPair> ValidationPairs(const PhotoSource& people, std::span<const int> persons, int per_person);

}  // namespace bodyloom
