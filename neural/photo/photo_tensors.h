// SPDX-License-Identifier: Apache-2.0
/// Frames of the one-photo renderer as tensors. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <span>
#include <vector>

#include "neural/photo/photo_window.h"
#include "render/texture/complete/partial_texture.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// T_s: colours 2c − 1 in [−1, 1].
struct TextureTensors {
  torch::Tensor colour;   ///< B×3×U×U, 0 where not visible
  torch::Tensor visible;  ///< B×1×U×U, 0 or 1
  torch::Tensor guess;    ///< B×3×U×U, 0 where not guessed; undefined where nothing is
};
TextureTensors ToTensors(std::span<const PartialTexture> textures);

/// P_t: what the pixels of equal windows see of the body.
struct PoseTensors {
  torch::Tensor uv;     ///< B×2×h×w
  torch::Tensor parts;  ///< B×1×h×w, part/24
  torch::Tensor body;   ///< B×1×h×w, 0 or 1
};
PoseTensors PoseOf(std::span<const PhotoFrame> frames, std::span<const PhotoWindow> windows);

/// I_t in the same windows.
struct PictureTensors {
  torch::Tensor image;       ///< B×3×h×w, 0 on the background
  torch::Tensor foreground;  ///< B×1×h×w, 0 or 1: labels other than 0, else where the picture is not black
};
PictureTensors PictureTensorsOf(std::span<const PhotoFrame> frames, std::span<const PhotoWindow> windows);

/// All throw std::invalid_argument when sizes do not fit each other or a window is not inside its frame.

}  // namespace bodyloom
