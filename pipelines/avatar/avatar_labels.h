// SPDX-License-Identifier: Apache-2.0
/// What the pixels of a person of Gaussians show, as a single-person dataset says it.
#pragma once

#include <span>

#include "bodyloom/geometry/person_label.h"
#include "bodyloom/render/splat/splat_picture.h"

namespace bodyloom {

constexpr float kLeastAlpha = 0.5F;         ///< of a pixel that shows the person
constexpr float kLeastGarmentShare = 0.5F;  ///< of a pixel that shows the garment

/// A pixel's label: kBottom where the garment (skirt, dress or coat) makes at least kLeastGarmentShare of it, kSkin on the
/// rest of the person, whose clothes nobody told apart, kBackground where alpha is below kLeastAlpha. Index in all channels, width ×
/// height. `garment`: its share of the window's pixels; empty: none is worn.
Image LabelsOf(const SplatPicture& picture, std::span<const float> garment, int width, int height);

}  // namespace bodyloom
