// SPDX-License-Identifier: Apache-2.0
/// Decodes the two outputs of BlazePose's person detector for an image.
///
/// The network takes 224 × 224 pixels and gives 12 numbers and a score logit for each of 2254 anchors: grids of 28 ×
/// 28, 14 × 14 and 7 × 7 cells, rows outer, columns inner, with 2, 2 and 6 anchors a cell, all at its centre. The
/// numbers are centre x, y, width and height of a box around the face and four points x, y, in pixels of the 224,
/// centre and points relative to the anchor. Score: sigmoid(logit limited to ±100); a detection has at least ½.
/// Detections whose boxes overlap (intersection over union above 0.3) are one person: box and points are means weighted
/// by score, the score is the maximum.
/// Source: MediaPipe, pose_detection_cpu.pbtxt: SsdAnchorsCalculator, TensorsToDetectionsCalculator,
/// NonMaxSuppressionCalculator (WEIGHTED).
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace bodyloom {

struct PersonDetection {
  /// Positions as fractions of the network's crop (x right, y down).
  Eigen::Vector2d box_min = Eigen::Vector2d::Zero(), box_max = Eigen::Vector2d::Zero();
  /// 0 middle of the hips; 1 on a circle about them that holds the whole body, above the head; 2 middle of the
  /// shoulders; 3 the same as 1 for the upper body.
  std::array<Eigen::Vector2d, 4> points = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                           Eigen::Vector2d::Zero()};
  double score = 0;  ///< ½ to 1
};

inline constexpr int kPersonDetectorSize = 224;  ///< pixels a side
inline constexpr int kPersonDetectorAnchors = 2254;

/// Decodes the people, best score first. boxes: 2254 × 12 numbers; logits: 2254. Throws std::invalid_argument for other
/// sizes. Anchors with numbers that are not finite, or with a negative width or height, are dropped.
std::vector<PersonDetection> DecodePersonDetections(std::span<const float> boxes, std::span<const float> logits,
                                                    double min_score = 0.5);

}  // namespace bodyloom
