// SPDX-License-Identifier: Apache-2.0
/// Losses specific to the one-photo renderer. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "neural/networks/sphereface.h"
#include "neural/photo/photo_tensors.h"

namespace bodyloom {

/// L_tex: mean |F_s[:3] − T_s| over the texels visible in the source plus mean |F_s[:3] − T_t| over those visible in
/// the target; colours 2c − 1.
torch::Tensor TextureLoss(const torch::Tensor& features, const TextureTensors& source, const TextureTensors& target);

/// L_face: mean |N(I) − N(I_t)| over the faces (photo_window.h, FaceBox) of at least 16 pixels a side, their boxes
/// resized to 112 × 96 by bilinear interpolation; zero without gradient when there is none.
torch::Tensor FaceLoss(SphereFace network, const torch::Tensor& image, const torch::Tensor& truth,
                       const std::vector<PhotoWindow>& faces);

}  // namespace bodyloom
