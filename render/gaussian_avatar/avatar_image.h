// SPDX-License-Identifier: Apache-2.0
/// Converts the window in which a person of Gaussians was rendered to images of full size.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/scene/person_label.h"
#include "render/image/image.h"
#include "render/splat/splat_image.h"

namespace bodyloom {

/// Composites the person over the image `whole`.
void LayOver(const SplatImage& image, Image* whole);

/// height × width × 4: blue, green, red (not premultiplied) and alpha; 0 outside the window.
std::vector<uint8_t> WithAlpha(const SplatImage& image, int width, int height);

// Pixel labels of a rendered person of Gaussians in the format of a single-person dataset.

constexpr float kMinAlpha = 0.5F;         ///< of a pixel of the person
constexpr float kMinGarmentShare = 0.5F;  ///< of a pixel of the garment

/// Label image: kBottom where the garment (skirt, dress or coat) covers at least kMinGarmentShare of a pixel, kSkin on
/// the rest of the person, whose clothes are not distinguished, kBackground where alpha is below kMinAlpha. Index in
/// all channels, width × height. `garment`: its share of each pixel of the window; empty: none is worn.
Image LabelsOf(const SplatImage& image, std::span<const float> garment, int width, int height);

}  // namespace bodyloom
