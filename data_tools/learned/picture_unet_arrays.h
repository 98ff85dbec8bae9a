// SPDX-License-Identifier: Apache-2.0
/// The numbers of a picture U-Net (render/person/picture_unet.h) as arrays of a .npz file: NAME (out × 9·in,
/// half-precision floats, so the file rounds them to 11 bits) and NAME_bias (out) of each of PictureUnetLayers().
#pragma once

#include <cstddef>
#include <string>

#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/render/person/picture_unet.h"

namespace bodyloom {

/// No file of such weights is larger.
inline constexpr size_t kMostPictureUnetBytes = size_t{1} << 26;

/// The weights are valid.
void PutPictureUnet(const PictureUnetWeights& weights, PictureUnetPlanes planes, NpzArrays* arrays);
/// Sizes are for the caller to check (IsValid()). Throws std::runtime_error naming the file, the array and what was
/// expected.
PictureUnetWeights PictureUnetFrom(const NpzArrays& arrays, PictureUnetPlanes planes, const std::string& where);

}  // namespace bodyloom
