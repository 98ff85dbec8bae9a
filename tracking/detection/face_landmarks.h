// SPDX-License-Identifier: Apache-2.0
/// Landmarks of a face in an image, by MediaPipe's network.
///
/// The body's points of the face give a region (FaceRegionOfBody()); the network looks twice, the second time at the
/// region of its own first points (FaceRegionOfPoints()). It takes a region as 192 × 192 pixels and gives 468 points
/// (x, y, z in those pixels) and the logit of the probability that a face is there. Of the points the 68 of 300-W are
/// kept (geometry/scene/hands_and_face.h): they have names that all detectors share, and tell the head's rotation as
/// well.
///
/// A region is a square (pose_region.h) that is turned so that the eyes are level.
/// Source: MediaPipe, face_landmarks_from_pose, face_landmarks_to_roi, face_landmark; without the face detector between
/// them, whose place the second look takes (docs/lab/hands.md).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geometry/scene/hands_and_face.h"
#include "render/image/image.h"
#include "tracking/detection/pose_region.h"

namespace bodyloom {

/// Around the body's points of the face (MediaPipe33()'s first 11: nose, eyes, ears, mouth), with the side twice the
/// longer one of their upright rectangle. Throws std::invalid_argument for another number of points.
PoseRegion FaceRegionOfBody(std::span<const Eigen::Vector2d> points);

/// Around the 468 points, with the side 1.5 times the longer one of their upright rectangle. Throws
/// std::invalid_argument for another number of points.
PoseRegion FaceRegionOfPoints(std::span<const Eigen::Vector2d> points);

inline constexpr int kFaceNetworkSize = 192, kFaceNetworkLandmarks = 468;

struct DetectedFace {
  double presence = 0;                  ///< probability that a face is in the region
  PoseRegion region;                    ///< input of the network
  std::vector<Eigen::Vector2d> points;  ///< 468 pixels of the image
  std::vector<double> depth_px;         ///< 468, in the scale of `points`, smaller is nearer
};

/// `landmarks`: the network's 468 · 3 numbers, `presence`: its logit. Throws std::invalid_argument for another number.
DetectedFace DecodeFace(std::span<const float> landmarks, float presence, const PoseRegion& region);

/// The face's 68 points. Standard deviation along an axis: ((side / 100)² + 0.5²)^½ pixels, with the region's side and
/// half a pixel: the noise from frame to frame and the change when pictures are made smaller (docs/lab/hands.md); how
/// far the points lie from a face's own was not measured.
FaceObservation FaceOf(const DetectedFace& face);

/// Any number of threads may use one at once.
class FaceDetector {
 public:
  /// Reads the network from a folder, or where it is installed when it is empty (model_files.h). Throws
  /// std::runtime_error naming a file that is missing or no such network.
  explicit FaceDetector(const std::string& folder);
  ~FaceDetector();
  FaceDetector(FaceDetector&&) noexcept;
  FaceDetector& operator=(FaceDetector&&) noexcept;

  /// The face in a region, which may be empty: DetectedFace::presence.
  [[nodiscard]] DetectedFace FaceIn(const Image& image, const PoseRegion& region) const;

 private:
  class Network;
  std::unique_ptr<const Network> network_;
};

}  // namespace bodyloom
