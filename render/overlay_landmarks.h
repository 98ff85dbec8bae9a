// SPDX-License-Identifier: Apache-2.0
/// The landmarks of an overlay: those detected as discs, the body's own as rings or as a skeleton, and lines between
/// the two, so that residuals can be seen.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/camera.h"
#include "bodyloom/geometry/observations.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/render/caption.h"
#include "bodyloom/render/image.h"

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

}  // namespace bodyloom
