// SPDX-License-Identifier: Apache-2.0
/// The pictures of one training step. Internal: includes LibTorch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bodyloom/neural/photo/photo_tensors.h"
#include "bodyloom/render/texture/complete/texel_neighbours.h"
#include "bodyloom/render/texture/photo_frame.h"

namespace bodyloom {

// Training pairs of a step: pictures of one person in two poses.

struct PhotoPair {
  int person = 0, source = 0, target = 0;  ///< frames of the person
};

/// The pair at place `place` of step `step`'s batch: a person of `persons`, each as likely, one of its frames, each as
/// likely, and another of another pose (neural/training/photo_partner.h). A function of these numbers alone. Throws
/// std::invalid_argument when there is no person or one has no frames.
PhotoPair DrawPhotoPair(const PhotoSource& people, std::span<const int> persons, uint64_t seed, int64_t step,
                        int place);

/// `per_person` pairs of each person, the same for every seed: to compare runs on.
std::vector<PhotoPair> ValidationPairs(const PhotoSource& people, std::span<const int> persons, int per_person);

struct PhotoBatch {
  TextureTensors source, target;   ///< T_s and T_t
  PoseTensors pose;                ///< P_t
  PictureTensors truth;            ///< I_t
  std::vector<PhotoWindow> faces;  ///< in the windows of truth; width 0 where none looks at the camera; or empty
};

/// Windows: neural/photo/photo_window.h, the largest one's sides for all. `guess`: what the source's texture is filled
/// with where nothing is seen; null: with nothing. `back_of_head` (render/texture/complete/body_part_map.h): for the
/// faces; empty: nobody looks at them.
PhotoBatch MakePhotoBatch(const PhotoSource& source, std::span<const PhotoPair> pairs, int reach, int smallest_side,
                          const TexelNeighbours* guess = nullptr, std::span<const uint8_t> back_of_head = {});

}  // namespace bodyloom
