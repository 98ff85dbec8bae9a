// SPDX-License-Identifier: Apache-2.0
/// Batch of one training step. Internal: includes LibTorch.
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
  ImageTensors truth;              ///< I_t
  std::vector<PhotoWindow> faces;  ///< in the windows of truth; width 0 if no face is turned to the camera; or empty
};

/// Creates a batch. Windows: neural/photo/photo_window.h, all with the size of the largest. `guess`: fills unseen
/// texels of the source's texture; null: not filled. `back_of_head` (render/texture/complete/body_part_map.h): to find
/// faces; empty: faces are not needed.
PhotoBatch MakePhotoBatch(const PhotoSource& source, std::span<const PhotoPair> pairs, int reach, int smallest_side,
                          const TexelNeighbours* guess = nullptr, std::span<const uint8_t> back_of_head = {});

}  // namespace bodyloom
