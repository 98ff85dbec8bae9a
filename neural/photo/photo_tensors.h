// SPDX-License-Identifier: Apache-2.0
/// Converts frames of the one-photo renderer to tensors. Internal: includes LibTorch.
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
  torch::Tensor guess;    ///< B×3×U×U, 0 where not guessed; undefined without guesses
};
TextureTensors ToTensors(std::span<const PartialTexture> textures);

/// P_t: the body's surface coordinates and parts at the pixels of windows of one size.
struct PoseTensors {
  torch::Tensor uv;     ///< B×2×h×w
  torch::Tensor parts;  ///< B×1×h×w, part/24
  torch::Tensor body;   ///< B×1×h×w, 0 or 1
};
PoseTensors PoseOf(std::span<const PhotoFrame> frames, std::span<const PhotoWindow> windows);

/// I_t in the same windows.
struct ImageTensors {
  torch::Tensor image;       ///< B×3×h×w, 0 on the background
  torch::Tensor foreground;  ///< B×1×h×w, 0 or 1: labels other than 0, else where the image is not black
};
ImageTensors ImageTensorsOf(std::span<const PhotoFrame> frames, std::span<const PhotoWindow> windows);

/// All functions throw std::invalid_argument when sizes do not fit each other or a window is not inside its frame.

}  // namespace bodyloom
