// SPDX-License-Identifier: Apache-2.0
/// Draws the landmarks of an overlay: detected ones as discs, the body's as rings or a skeleton, and lines between the
/// two that show residuals.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/observations.h"
#include "render/image/image.h"
#include "render/view/caption.h"

namespace bodyloom {

/// A body in the camera of one frame.
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

/// Landmarks are matched by name; those that the body lacks are left out. `detected` may be null: then only the
/// skeleton is drawn, with COCO's landmarks. Sizes scale with the image's height. Throws std::invalid_argument when
/// `frame` is not among the detections.
void DrawOverlayLandmarks(const BodyInView& seen, const KeypointSequence* detected, int frame,
                          const OverlayLandmarksStyle& style, Image* image);

/// Caption lines that explain the marks.
std::vector<CaptionLine> LandmarkLegend(bool skeleton);

// Draws 2D landmarks and the bones between them. Landmarks have the body's names (left_elbow, …); a bone is drawn if
// both its ends are present. Left is warm, right is cool.

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

/// Draws thin lines from each detected point to its projected counterpart (same names and order) to show errors.
void DrawResiduals(const DrawnKeypoints& detected, const DrawnKeypoints& projected, double width_px, Image* image);

/// Draws the bones of the fingers and the lines of the face, thinner than a body's; left is warm, right is cool. Points
/// at or below min_confidence are left out, and bones and lines that end in them.
void DrawHandsAndFace(const HandsAndFace& hands_and_face, double min_confidence, Image* image);

}  // namespace bodyloom
