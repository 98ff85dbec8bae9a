// SPDX-License-Identifier: Apache-2.0
/// The landmarks of an overlay: those detected as discs, the body's own as rings or as a skeleton, and lines between
/// the two, so that residuals can be seen.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "render/image/image.h"
#include "render/view/caption.h"

namespace bodyloom {

/// A body as one frame's camera sees it.
struct BodyInView {
  const BodyModel* body = nullptr;
  Eigen::VectorXd betas;
  BodyPose pose;  ///< camera frame
  Camera camera;
};

struct OverlayLandmarksStyle {
  bool skeleton = false;        ///< bones between the body's landmarks instead of rings at them
  double min_confidence = 0.1;  ///< detections at or below are not drawn
};

/// Landmarks go by names; those that the body does not know are left out. `detected` may be null: then only the
/// skeleton is drawn, with COCO's landmarks. Sizes go by the image's height. Throws std::invalid_argument when `frame`
/// is not among the detections.
void DrawOverlayLandmarks(const BodyInView& seen, const KeypointSequence* detected, int frame,
                          const OverlayLandmarksStyle& style, Image* image);

/// The key to these marks.
std::vector<CaptionLine> LandmarkLegend(bool skeleton);

// Draws 2D landmarks and the bones between them. Landmarks go by the body's names (left_elbow, …); a bone is drawn
// when both its ends are there. Left is warm, right is cool.

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
