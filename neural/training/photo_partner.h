// SPDX-License-Identifier: Apache-2.0
/// Pairs of images of one person, a source and a target, for the training of the one-photo renderers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Difference required between the target of a pair and its source.
enum class PartnerDiffers {
  kPose,        ///< "the same person (but in different poses)": Sarkar et al., ECCV 2020, Section 3.5
  kPoseAndView  ///< "with different views and 3D poses": Yoon et al., CVPR 2021, Section 3.1.1
};

/// Chooses a target frame of the person for `source`, uniformly among those that differ as requested; if there are
/// none, among those of another pose; if there are none, among all others; else `source` itself. `uniform` in [0, 1)
/// selects it. Throws std::invalid_argument for a person or frame out of range, and when people.places and
/// people.num_frames differ in size.
int PartnerOf(const PhotoSource& people, int person, int source, PartnerDiffers differs, double uniform);

// Draws the training pairs of a step: images of one person in two poses.

struct PhotoPair {
  int person = 0, source = 0, target = 0;  ///< frames of the person
};

/// The pair at place `place` of step `step`'s batch: a person of `persons` and one of its frames, both uniformly
/// distributed, and a frame of another pose (PartnerOf()). Deterministic. Throws
/// std::invalid_argument when there is no person or one has no frames.
PhotoPair DrawPhotoPair(const PhotoSource& people, std::span<const int> persons, uint64_t seed, int64_t step,
                        int place);

/// `per_person` pairs of each person, independent of the seed, for comparison of runs.
std::vector<PhotoPair> ValidationPairs(const PhotoSource& people, std::span<const int> persons, int per_person);

}  // namespace bodyloom
