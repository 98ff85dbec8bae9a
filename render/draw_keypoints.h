// SPDX-License-Identifier: Apache-2.0
/// Draws 2D landmarks and the bones between them. Landmarks go by the body's names (left_elbow, …); a bone is drawn
/// when both its ends are there. Left is warm, right is cool.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

/// Landmarks of one frame: names and n×2 pixels; a row that is not finite is missing. `confidence` has n entries or
/// none (all 1); points at or below min_confidence are left out.
struct DrawnKeypoints {
  std::vector<std::string> names;
  MatrixX2d pixels;
  std::vector<float> confidence;
  double min_confidence = 0;
};

struct KeypointStyle {
  double size_px = 4;  ///< radius of a point; bones are 0.7 of it wide
  bool bones = true;
  bool hollow = false;  ///< rings instead of discs: for projected points beside detected ones
  double alpha = 1;
};

void DrawKeypoints(const DrawnKeypoints& keypoints, const KeypointStyle& style, Image* image);

/// Thin lines from each detected point to its projected twin (same names and order), so that errors can be seen.
void DrawResiduals(const DrawnKeypoints& detected, const DrawnKeypoints& projected, double width_px, Image* image);

}  // namespace bodyloom
