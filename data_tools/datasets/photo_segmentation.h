// SPDX-License-Identifier: Apache-2.0
/// Segmentation of an unlabelled photo: the person's labels, and the background without the person.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/scene/observations.h"
#include "geometry/scene/person_label.h"
#include "render/image/image.h"

namespace bodyloom {

/// Labels (PersonLabel) of an image around a person whose bare body is known: `parts` holds DensePose's part of every
/// pixel, 0 off the body. The silhouette is found by GrabCut (Rother, Kolmogorov, Blake 2004; OpenCV's), which starts
/// from the body's and may exceed it by a twelfth of the body's extent; the class is that of the nearest pixel of the
/// body. A substitute for a parsing network: skirts become trousers, hair becomes face. Where colours do not separate
/// person and background, the bare body's silhouette is used. Throws std::invalid_argument when sizes differ or the
/// body is not in the image.
std::vector<uint8_t> LabelsFromBody(const Image& image, const std::vector<uint8_t>& parts);

/// The image with the pixels that `hide` marks (not 0) filled from their boundary by Telea's method (2004; OpenCV's) on
/// an image shrunk to at most 512 pixels, so the fill is smooth. Throws std::invalid_argument when sizes differ.
Image FilledBackground(const Image& image, const std::vector<uint8_t>& hide);

/// For every pixel of width × height, the index of the nearest pixel that `marked` marks (not 0), its own where it is
/// marked; −1 everywhere if none is. Distances are chamfer ones of 5×5 (OpenCV's), within 2 % of Euclid's. Throws
/// std::invalid_argument when sizes differ.
std::vector<int> NearestMarked(std::span<const uint8_t> marked, int width, int height);

// Clothing class of a body part, for photos without labels of the clothes.

/// An image of `width` × `height` with these classes in the first channel, in the form that CutLabels takes. Unknown
/// parts (255) inside the person's silhouette count as top.
inline Image LabelsAsImage(const LabelImage& parts, int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.pixel(x, y)[0] = static_cast<uint8_t>(LabelOfPart(parts.At(x, y)));
  }
  return image;
}

}  // namespace bodyloom
