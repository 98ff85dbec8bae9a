// SPDX-License-Identifier: Apache-2.0
/// Losses of the one-photo renderer that no other network has. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "neural/networks/sphereface.h"
#include "neural/photo/photo_tensors.h"

namespace bodyloom {

/// L_tex: mean |F_s[:3] − T_s| over the texels that the source shows plus mean |F_s[:3] − T_t| over those that the
/// target shows; colours 2c − 1.
torch::Tensor TextureLoss(const torch::Tensor& features, const TextureTensors& source, const TextureTensors& target);

/// L_face: mean |N(I) − N(I_t)| over the faces (photo_window.h, FaceBox) of at least 16 pixels a side, their boxes
/// enlarged to 112 × 96 by bilinear interpolation; a zero without gradient when there is none.
torch::Tensor FaceLoss(SphereFace network, const torch::Tensor& image, const torch::Tensor& truth,
                       const std::vector<PhotoWindow>& faces);

}  // namespace bodyloom
