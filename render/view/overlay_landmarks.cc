// SPDX-License-Identifier: Apache-2.0
#include "render/view/overlay_landmarks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "geometry/base/check.h"
#include "render/image/image_mat.h"
#include "render/image/palette.h"
#include "render/view/drawing_units.h"

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

namespace {

using Bone = std::pair<const char*, const char*>;
constexpr std::array<Bone, 24> kBones = {{
    {"left_shoulder", "right_shoulder"},
    {"left_hip", "right_hip"},
    {"left_shoulder", "left_hip"},
    {"right_shoulder", "right_hip"},
    {"left_shoulder", "left_elbow"},
    {"left_elbow", "left_wrist"},
    {"right_shoulder", "right_elbow"},
    {"right_elbow", "right_wrist"},
    {"left_hip", "left_knee"},
    {"left_knee", "left_ankle"},
    {"right_hip", "right_knee"},
    {"right_knee", "right_ankle"},
    {"left_ankle", "left_big_toe"},
    {"left_ankle", "left_heel"},
    {"left_big_toe", "left_small_toe"},
    {"right_ankle", "right_big_toe"},
    {"right_ankle", "right_heel"},
    {"right_big_toe", "right_small_toe"},
    {"nose", "left_eye"},
    {"left_eye", "left_ear"},
    {"nose", "right_eye"},
    {"right_eye", "right_ear"},
    {"neck", "nose"},
    {"neck", "mid_hip"},
}};

Colour SideColour(const std::string& a, const std::string& b) {
  const bool left = a.starts_with("left") || b.starts_with("left");
  const bool right = a.starts_with("right") || b.starts_with("right");
  if (left == right) return kMiddleColour;
  return left ? kLeftColour : kRightColour;
}

/// False for points that are missing, below the confidence, or so far outside that OpenCV's fixed point would overflow.
bool IsDrawn(const DrawnKeypoints& keypoints, int k) {
  if (!IsDrawable(keypoints.pixels.row(k).transpose())) return false;
  return keypoints.confidence.empty() || keypoints.confidence[k] > keypoints.min_confidence;
}

cv::Point PointOf(const DrawnKeypoints& keypoints, int k) { return FixedPoint(keypoints.pixels.row(k).transpose()); }

void CheckSizes(const DrawnKeypoints& keypoints) {
  const auto n = static_cast<Eigen::Index>(keypoints.names.size());
  BODYLOOM_CHECK(keypoints.pixels.rows() == n, "keypoints: ", n, " names, ", keypoints.pixels.rows(), " pixels");
  BODYLOOM_CHECK(keypoints.confidence.empty() || static_cast<Eigen::Index>(keypoints.confidence.size()) == n,
                 "keypoints: ", n, " names, ", keypoints.confidence.size(), " confidences");
}

/// Draws opaquely on a copy of the affected box and blends it back.
template <typename Draw>
void Blend(const cv::Rect& touched, double alpha, Image* image, const Draw& draw) {
  cv::Mat whole = MatOf(image);
  if (alpha >= 1) {
    draw(whole);
    return;
  }
  const cv::Rect box = touched & cv::Rect(0, 0, image->width, image->height);
  if (box.empty()) return;
  const cv::Mat before = whole(box).clone();
  draw(whole);
  cv::Mat part = whole(box);
  cv::addWeighted(part, alpha, before, 1 - alpha, 0, part);
}

}  // namespace

void DrawKeypoints(const DrawnKeypoints& keypoints, const KeypointStyle& style, Image* image) {
  CheckSizes(keypoints);
  const int n = static_cast<int>(keypoints.names.size());
  const double r = style.size_px;
  cv::Rect touched;
  for (int k = 0; k < n; ++k) {
    if (!IsDrawn(keypoints, k)) continue;
    const int margin = static_cast<int>(2 * r) + 3;
    const cv::Rect box(static_cast<int>(keypoints.pixels(k, 0)) - margin,
                       static_cast<int>(keypoints.pixels(k, 1)) - margin, 2 * margin, 2 * margin);
    touched = touched.empty() ? box : touched | box;
  }
  const auto find = [&](const char* name) {
    const auto it = std::find(keypoints.names.begin(), keypoints.names.end(), name);
    const int k = static_cast<int>(it - keypoints.names.begin());
    return it != keypoints.names.end() && IsDrawn(keypoints, k) ? k : -1;
  };
  Blend(touched, style.alpha, image, [&](cv::Mat& mat) {
    const int width = std::max(1, static_cast<int>(std::lround(0.7 * r)));
    if (style.bones) {
      for (const bool border : {true, false}) {  // dark borders first, so that crossing bones stay readable
        for (const Bone& bone : kBones) {
          const int a = find(bone.first), b = find(bone.second);
          if (a < 0 || b < 0) continue;
          cv::line(mat, PointOf(keypoints, a), PointOf(keypoints, b),
                   ScalarOf(border ? kInkColour : SideColour(bone.first, bone.second)), width + (border ? 2 : 0),
                   cv::LINE_AA, kDrawingShift);
        }
      }
    }
    for (int k = 0; k < n; ++k) {
      if (!IsDrawn(keypoints, k)) continue;
      const cv::Point p = PointOf(keypoints, k);
      const Colour colour = SideColour(keypoints.names[k], keypoints.names[k]);
      const auto fixed = [&](double radius) { return static_cast<int>(std::lround(radius * (1 << kDrawingShift))); };
      if (style.hollow) {
        const int ring = std::max(1, static_cast<int>(std::lround(0.35 * r)));
        cv::circle(mat, p, fixed(r), ScalarOf(kInkColour), ring + 2, cv::LINE_AA, kDrawingShift);
        cv::circle(mat, p, fixed(r), ScalarOf(kPaperColour), ring, cv::LINE_AA, kDrawingShift);
      } else {
        cv::circle(mat, p, fixed(r + 1.2), ScalarOf(kInkColour), cv::FILLED, cv::LINE_AA, kDrawingShift);
        cv::circle(mat, p, fixed(r), ScalarOf(colour), cv::FILLED, cv::LINE_AA, kDrawingShift);
      }
    }
  });
}

void DrawResiduals(const DrawnKeypoints& detected, const DrawnKeypoints& projected, double width_px, Image* image) {
  CheckSizes(detected);
  CheckSizes(projected);
  BODYLOOM_CHECK(detected.names == projected.names, "residuals: detected and projected points have different names");
  cv::Mat mat = MatOf(image);
  for (int k = 0; k < static_cast<int>(detected.names.size()); ++k) {
    if (!IsDrawn(detected, k) || !IsDrawn(projected, k)) continue;
    cv::line(mat, PointOf(detected, k), PointOf(projected, k), ScalarOf(kPaperColour),
             std::max(1, static_cast<int>(std::lround(width_px))), cv::LINE_AA, kDrawingShift);
  }
}

namespace {

/// Lines between seen points, and discs at them where `discs`.
void DrawPoints(std::span<const Keypoint> points, std::span<const std::pair<int, int>> lines, Colour colour,
                double min_confidence, bool discs, Image* image) {
  const auto seen = [&](int k) { return points[size_t(k)].confidence > min_confidence; };
  const auto place = [&](int k) { return FixedPoint(Eigen::Vector2d(points[size_t(k)].x, points[size_t(k)].y)); };
  cv::Mat mat = MatOf(image);
  const double radius = std::max(1.0, image->height / 540.0);
  const int width = std::max(1, int(std::lround(0.8 * radius)));
  for (const bool border : {true, false}) {  // dark borders first, so that crossing fingers stay readable
    for (const auto& [a, b] : lines) {
      if (!seen(a) || !seen(b)) continue;
      cv::line(mat, place(a), place(b), ScalarOf(border ? kInkColour : colour), width + (border ? 2 : 0), cv::LINE_AA,
               kDrawingShift);
    }
  }
  for (int k = 0; discs && k < int(points.size()); ++k) {
    if (!seen(k)) continue;
    cv::circle(mat, place(k), int(std::lround(radius * (1 << kDrawingShift))), ScalarOf(colour), cv::FILLED,
               cv::LINE_AA, kDrawingShift);
  }
}

}  // namespace

void DrawHandsAndFace(const HandsAndFace& hands_and_face, double min_confidence, Image* image) {
  for (const auto side : {HandsAndFace::kLeft, HandsAndFace::kRight}) {
    const std::optional<HandObservation>& hand = hands_and_face.hands[side];
    const Colour colour = side == HandsAndFace::kLeft ? kLeftColour : kRightColour;
    if (hand) DrawPoints(hand->points, HandBones(), colour, min_confidence, true, image);
  }
  if (hands_and_face.face) {
    DrawPoints(hands_and_face.face->points, FaceLines(), kPaperColour, min_confidence, false, image);
  }
}

}  // namespace bodyloom
