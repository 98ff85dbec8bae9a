// SPDX-License-Identifier: Apache-2.0
/// What networks of the ONNX format are shown of a picture: a rectangle of it without a turn, scaled to their size.
///
/// A crop's place p and the image's x are related by  p = gain · x + shift,  along each axis alike: centre and scale of
/// the networks' own training code, so that landmarks come out as their labels were given (COCO's pixels).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

/// A box in an image: pixels, x0 < x1, y0 < y1.
struct PersonBox {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  double score = 0;  ///< how sure the detector is, 0 to 1
};

struct PictureCrop {
  int width = 0, height = 0;                     ///< pixels of the crop
  Eigen::Array2d gain = {1, 1}, shift = {0, 0};  ///< of x and y
  [[nodiscard]] Eigen::Array2d ImageFromCrop(const Eigen::Array2d& place) const { return (place - shift) / gain; }
};

/// The whole image, as large as it fits width × height, its middle in the middle. Gain min(width / w, height / h), the
/// image's rows and columns rounded to whole ones, and so the borders.
/// Source: Ultralytics, LetterBox and ops.scale_boxes.
PictureCrop LetterboxCrop(int image_width, int image_height, int width, int height);

/// The image in a letterbox: 3 · height · width floats, red, green, blue planes, value / 255; 114 / 255 around it.
std::vector<float> LetterboxPixels(const Image& image, const PictureCrop& crop);

/// A person's box 1.25 times as large, made wider or taller to the crop's proportions.
/// Throws std::invalid_argument for a box that is not finite or has no area.
/// Source: MMPose, GetBBoxCenterScale and TopdownAffine.
PictureCrop TopDownCrop(const PersonBox& box, int width, int height);

/// The crop, sampled bilinearly, black outside the image: 3 · height · width floats, red, green, blue planes, less the
/// mean (123.675, 116.28, 103.53) and divided by the deviation (58.395, 57.12, 57.375) of ImageNet's pictures.
std::vector<float> TopDownPixels(const Image& image, const PictureCrop& crop);

}  // namespace bodyloom
