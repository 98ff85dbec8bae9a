// SPDX-License-Identifier: Apache-2.0
/// Decodes the outputs of BlazePose's landmark network for a region of an image.
///
/// The network takes a region as 256 × 256 pixels and gives 39 landmarks (x, y, z in pixels of the 256, logits of
/// visibility and presence), the probability that a person is there, a mask of logits 256 × 256, heatmaps of logits
/// 64 × 64 × 39, and the landmarks in metres. The first 33 landmarks are the body's (MediaPipe33()); 33 and 34 are the
/// middle of the hips and a point on the body's circle, from which the next frame's region comes; 35 to 38 are not
/// used.
///
/// Positions are refined by the heatmaps: with p = sigmoid(logit) in the 7 × 7 cells around the landmark's cell,
/// clipped at the border, and max p at least ½, x = Σ p·column / Σ p / 64 and y likewise.
/// Source: MediaPipe, pose_landmarks_by_roi_cpu.pbtxt: TensorsToPoseLandmarksAndSegmentation,
/// RefineLandmarksFromHeatmapCalculator, LandmarkProjectionCalculator, WorldLandmarkProjectionCalculator.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "geometry/scene/observations.h"
#include "tracking/detection/pose_region.h"

namespace bodyloom {

struct PoseLandmark {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< of the image
  double depth_px = 0;    ///< relative to the middle of the hips, smaller is nearer, in the scale of `pixel`
  double visibility = 0;  ///< probability that it is in the image and not occluded
  double heat = 0;        ///< largest probability in the heatmap's window; 0 outside the heatmap
  /// Metres from the middle of the hips: x right, y down, z away from the camera.
  Eigen::Vector3d world = Eigen::Vector3d::Zero();
};

struct DetectedPose {
  double presence = 0;  ///< probability that a person is in the region; below ½ the other fields have no meaning
  PoseRegion region;    ///< input of the network
  std::array<PoseLandmark, 33> landmarks = {};
  Eigen::Vector2d hips = Eigen::Vector2d::Zero(), rim = Eigen::Vector2d::Zero();  ///< for RegionAroundBody(), pixels
  LabelImage mask;  ///< 1 where the person is, clipped to the region; empty when no mask was requested
};

inline constexpr int kPoseNetworkSize = 256, kPoseHeatmapSize = 64, kPoseNetworkLandmarks = 39;

/// Outputs of the network in TensorFlow's order of memory.
struct PoseNetworkOutputs {
  std::span<const float> landmarks;  ///< 39 · 5
  float presence = 0;                ///< a probability already
  std::span<const float> mask;       ///< 256 · 256 logits, or empty
  std::span<const float> heatmaps;   ///< 64 · 64 · 39 logits
  std::span<const float> world;      ///< 39 · 3
};

/// Throws std::invalid_argument for spans of other sizes. A mask is clipped to an image of image_width × image_height.
DetectedPose DecodePose(const PoseNetworkOutputs& outputs, const PoseRegion& region, int image_width, int image_height);

/// Mean distance of the body's 33 landmarks, relative to the smaller of the two regions' sides.
double PoseDistance(const DetectedPose& a, const DetectedPose& b);

}  // namespace bodyloom
