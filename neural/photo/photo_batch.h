// SPDX-License-Identifier: Apache-2.0
/// The pictures of one training step. Internal: includes LibTorch.
#pragma once

#include <span>
#include <vector>

#include "neural/photo/photo_pairs.h"
#include "neural/photo/photo_tensors.h"
#include "render/texture/complete/texel_neighbours.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

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
