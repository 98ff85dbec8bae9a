// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/overlay_landmarks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/render/draw_keypoints.h"
#include "bodyloom/render/palette.h"

namespace bodyloom {
namespace {

DrawnKeypoints Projected(const BodyInView& seen, std::vector<std::string> names) {
  DrawnKeypoints projected;
  projected.names = std::move(names);
  std::erase_if(projected.names, [&](const std::string& name) { return seen.body->FindLandmark(name) < 0; });
  const MatrixX3d points = PoseLandmarks(*seen.body, seen.betas, seen.pose, projected.names);
  projected.pixels.resize(points.rows(), 2);
  for (int k = 0; k < points.rows(); ++k) {
    Eigen::Vector2d pixel;
    if (!seen.camera.Project(points.row(k).transpose(), &pixel)) pixel.setConstant(std::nan(""));
    projected.pixels.row(k) = pixel.transpose();
  }
  return projected;
}

DrawnKeypoints Detected(const KeypointSequence& detected, int frame, const std::vector<std::string>& names,
                        double min_confidence) {
  DrawnKeypoints drawn;
  drawn.names = names;
  drawn.min_confidence = min_confidence;
  drawn.pixels.resize(Eigen::Index(names.size()), 2);
  for (size_t k = 0; k < names.size(); ++k) {
    const auto it = std::find(detected.names.begin(), detected.names.end(), names[k]);
    const Keypoint& p = detected.at(frame, static_cast<int>(it - detected.names.begin()));
    drawn.pixels.row(Eigen::Index(k)) << p.x, p.y;
    drawn.confidence.push_back(p.confidence);
  }
  return drawn;
}

}  // namespace

void DrawOverlayLandmarks(const BodyInView& seen, const KeypointSequence* detected, int frame,
                          const OverlayLandmarksStyle& style, Image* image) {
  const DrawnKeypoints projected = Projected(seen, detected != nullptr ? detected->names : CocoNames());
  const double size = std::max(2.0, image->height / 220.0);
  if (style.skeleton) {
    DrawKeypoints(projected, {.size_px = size}, image);
  }
  if (detected == nullptr) return;
  BODYLOOM_CHECK(frame < detected->num_frames(), "overlay: frame ", frame, " is outside the ", detected->num_frames(),
                 " frames of detections");
  const DrawnKeypoints drawn = Detected(*detected, frame, projected.names, style.min_confidence);
  if (!style.skeleton) DrawKeypoints(projected, {.size_px = 1.25 * size, .bones = false, .hollow = true}, image);
  DrawResiduals(drawn, projected, 0.4 * size, image);
  DrawKeypoints(drawn, {.size_px = 0.8 * size, .bones = false}, image);
}

std::vector<CaptionLine> LandmarkLegend(bool skeleton) {
  return {{"detected", CaptionLine::Mark::kDisc, kLeftColour},
          {skeleton ? "estimated (bones)" : "estimated", CaptionLine::Mark::kRing, kPaperColour}};
}

}  // namespace bodyloom
