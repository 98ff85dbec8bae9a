// SPDX-License-Identifier: Apache-2.0
/// Batch of one training step, and the losses on it. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>
#include <span>
#include <vector>

#include "neural/networks/sphereface.h"
#include "neural/photo/photo_tensors.h"
#include "neural/training/photo_partner.h"
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

// Losses specific to the one-photo renderer.

/// L_tex: mean |F_s[:3] − T_s| over the texels visible in the source plus mean |F_s[:3] − T_t| over those visible in
/// the target; colours 2c − 1.
torch::Tensor TextureLoss(const torch::Tensor& features, const TextureTensors& source, const TextureTensors& target);

/// L_face: mean |N(I) − N(I_t)| over the faces (photo_window.h, FaceBox) of at least 16 pixels a side, their boxes
/// resized to 112 × 96 by bilinear interpolation; zero without gradient when there is none.
torch::Tensor FaceLoss(SphereFace network, const torch::Tensor& image, const torch::Tensor& truth,
                       const std::vector<PhotoWindow>& faces);

}  // namespace bodyloom
