// SPDX-License-Identifier: Apache-2.0
/// Segmentation of an unlabelled photo: the person's labels, and the background without the person.
#pragma once

#include <cstdint>
#include <vector>

#include "bodyloom/render/image.h"

namespace bodyloom {

/// Labels (PersonLabel) of a picture around a person whose bare body is known: `parts` holds DensePose's part of every
/// pixel, 0 off the body. The silhouette is found by GrabCut (Rother, Kolmogorov, Blake 2004; OpenCV's), which starts
/// from the body's own and may leave it by a twelfth of the body's extent; the class is that of the nearest pixel of
/// the body (label_of_part.h). A substitute for a parsing network: skirts become trousers, hair becomes face. Where
/// colours do not tell person and background apart, the bare body's silhouette is what is left. Throws
/// std::invalid_argument when sizes differ or the body is not in the picture.
std::vector<uint8_t> LabelsFromBody(const Image& picture, const std::vector<uint8_t>& parts);

/// The picture without what `hide` marks (not 0): filled from its boundary by Telea's method (2004; OpenCV's) on a
/// picture shrunk to at most 512 pixels, so the fill is smooth. Throws std::invalid_argument when sizes differ.
Image FilledBackground(const Image& picture, const std::vector<uint8_t>& hide);

}  // namespace bodyloom
