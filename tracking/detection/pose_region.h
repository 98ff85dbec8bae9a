// SPDX-License-Identifier: Apache-2.0
/// Region of interest of a person: the rotated square of an image that is the input of a pose network, and its crop.
///
/// A point at fraction f of the crop (x right, y down, (0, 0) its corner, (1, 1) the opposite one) lies in the image at
///   centre + R(rotation) · ((f − ½) · side),   R(θ) = [[cos θ, −sin θ], [sin θ, cos θ]],
/// in pixels whose centres are at integers. The square may leave the image; outside the image is black.
/// Source: MediaPipe, AlignmentPointsRectsCalculator, RectTransformationCalculator and ImageToTensorCalculator.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

struct PoseRegion {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< pixels
  double side = 0;                                   ///< pixels
  double rotation = 0;  ///< radians, clockwise as seen in the image; 0: the crop is upright

  [[nodiscard]] Eigen::Vector2d ImageFromFraction(const Eigen::Vector2d& fraction) const;
  [[nodiscard]] Eigen::Vector2d FractionFromImage(const Eigen::Vector2d& pixel) const;
  /// True if centre and side are finite and the side is at least a pixel.
  [[nodiscard]] bool IsValid() const;
};

/// The region around a person from the middle of the hips and a point `rim` on the circle about it that holds the body
/// (both pixels): centre at the hips, side 2.5 · |rim − hips|, rotated so that hips → rim is up in the crop.
PoseRegion RegionAroundBody(const Eigen::Vector2d& hips, const Eigen::Vector2d& rim);

/// The smallest upright square around an image of that size, with the same centre (width/2, height/2).
PoseRegion WholeImageRegion(int width, int height);

/// Upright squares with side 1/`level` of the longer side, each overlapping the next by half, that together cover the
/// image; level 1 is the whole image's square. Empty for a level below 1.
std::vector<PoseRegion> TileRegions(int width, int height, int level);

/// The region as size × size pixels, sampled bilinearly at fractions column/size, row/size: size² · 3 floats, rows from
/// the top, red, green, blue, each scale · value + offset with values from 0 to 255.
/// Throws std::invalid_argument for an empty image, a region that is not valid or a size below 1.
std::vector<float> CropRegion(const Image& image, const PoseRegion& region, int size, float scale, float offset);

}  // namespace bodyloom
