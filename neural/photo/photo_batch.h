// SPDX-License-Identifier: Apache-2.0
/// The pictures of one training step. Internal: includes LibTorch.
#pragma once

#include <span>
#include <vector>

#include "bodyloom/neural/people/photo_frame.h"
#include "bodyloom/neural/people/texel_neighbours.h"
#include "bodyloom/neural/photo/photo_pairs.h"
#include "bodyloom/neural/photo/photo_tensors.h"

namespace bodyloom {

struct PhotoBatch {
  TextureTensors source, target;   ///< T_s and T_t
  PoseTensors pose;                ///< P_t
  PictureTensors truth;            ///< I_t
  std::vector<PhotoWindow> faces;  ///< in the windows of truth; width 0 where there is none
};

/// Windows: neural/photo/photo_window.h, the largest one's sides for all. `guess`: what the source's texture is filled
/// with where nothing is seen; null: with nothing.
PhotoBatch MakePhotoBatch(const PhotoSource& source, std::span<const PhotoPair> pairs, int reach, int smallest_side,
                          const TexelNeighbours* guess = nullptr);

}  // namespace bodyloom
