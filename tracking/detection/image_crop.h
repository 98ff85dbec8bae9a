// SPDX-License-Identifier: Apache-2.0
/// Crops of an image as input of ONNX networks: an upright rectangle, scaled to the network's input size.
///
/// Crop coordinates p and image coordinates x are related by  p = gain · x + shift  along each axis. Centre and scale
/// are those of the networks' own training code, so that landmarks are in the convention of their labels (COCO's
/// pixels).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

/// A box in an image: pixels, x0 < x1, y0 < y1.
struct PersonBox {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  double score = 0;  ///< confidence of the detector, 0 to 1
};

struct ImageCrop {
  int width = 0, height = 0;                     ///< pixels of the crop
  Eigen::Array2d gain = {1, 1}, shift = {0, 0};  ///< of x and y
  [[nodiscard]] Eigen::Array2d ImageFromCrop(const Eigen::Array2d& place) const { return (place - shift) / gain; }
};

/// The whole image, scaled to fit width × height and centred: gain min(width / w, height / h), with the numbers of rows
/// and columns of the scaled image and of the borders rounded to integers.
/// Source: Ultralytics, LetterBox and ops.scale_boxes.
ImageCrop LetterboxCrop(int image_width, int image_height, int width, int height);

/// Pixels of a letterbox crop: 3 · height · width floats, red, green, blue planes, value / 255; borders 114 / 255.
std::vector<float> LetterboxPixels(const Image& image, const ImageCrop& crop);

/// A person's box enlarged 1.25 times and extended to the aspect ratio of the crop.
/// Throws std::invalid_argument for a box that is not finite or has no area.
/// Source: MMPose, GetBBoxCenterScale and TopdownAffine.
ImageCrop TopDownCrop(const PersonBox& box, int width, int height);

/// Pixels of the crop, sampled bilinearly, black outside the image: 3 · height · width floats, red, green, blue planes,
/// normalised by ImageNet's mean (123.675, 116.28, 103.53) and standard deviation (58.395, 57.12, 57.375).
std::vector<float> TopDownPixels(const Image& image, const ImageCrop& crop);

}  // namespace bodyloom
