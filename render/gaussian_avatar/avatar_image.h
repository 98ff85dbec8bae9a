// SPDX-License-Identifier: Apache-2.0
/// The window in which a person of Gaussians was drawn, in a picture of the whole size.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/scene/person_label.h"
#include "render/image/image.h"
#include "render/splat/splat_picture.h"

namespace bodyloom {

/// Lays the person over the picture `whole`.
void LayOver(const SplatPicture& picture, Image* whole);

/// height × width × 4: straight colours and alpha, blue green red alpha as images have them; 0 outside the window.
std::vector<uint8_t> WithAlpha(const SplatPicture& picture, int width, int height);

// What the pixels of a person of Gaussians show, as a single-person dataset says it.

constexpr float kLeastAlpha = 0.5F;         ///< of a pixel that shows the person
constexpr float kLeastGarmentShare = 0.5F;  ///< of a pixel that shows the garment

/// A pixel's label: kBottom where the garment (skirt, dress or coat) makes at least kLeastGarmentShare of it, kSkin on
/// the rest of the person, whose clothes nobody told apart, kBackground where alpha is below kLeastAlpha. Index in all
/// channels, width × height. `garment`: its share of the window's pixels; empty: none is worn.
Image LabelsOf(const SplatPicture& picture, std::span<const float> garment, int width, int height);

}  // namespace bodyloom
