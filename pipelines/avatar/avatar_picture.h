// SPDX-License-Identifier: Apache-2.0
/// The window in which a person of Gaussians was drawn, in a picture of the whole size.
#pragma once

#include <cstdint>
#include <vector>

#include "bodyloom/render/image.h"
#include "bodyloom/render/splat/splat_picture.h"

namespace bodyloom {

/// Lays the person over the picture `whole`.
void LayOver(const SplatPicture& picture, Image* whole);

/// height × width × 4: straight colours and alpha, blue green red alpha as images have them; 0 outside the window.
std::vector<uint8_t> WithAlpha(const SplatPicture& picture, int width, int height);

}  // namespace bodyloom
