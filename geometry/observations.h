// SPDX-License-Identifier: Apache-2.0
/// What detectors saw in a clip: 2D keypoints and dense surface keypoints, one person, one camera.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace bodyloom {

/// A detected 2D landmark. Missing when confidence <= 0 or a coordinate is not finite.
struct Keypoint {
  float x = 0, y = 0;    ///< pixels
  float confidence = 0;  ///< clamped to [0, 1] by the readers
};

/// T frames × K named landmarks.
struct KeypointSequence {
  std::string convention;          ///< "coco17", "body25", "body25b", "mediapipe33", …
  std::vector<std::string> names;  ///< K landmark names in the body's vocabulary (nose, left_eye, …, right_heel)
  std::vector<Keypoint> points;    ///< T·K, frame-major
  std::vector<double> timestamps;  ///< T seconds, strictly increasing
  int image_width = 0, image_height = 0;  ///< 0 when the file does not say
  [[nodiscard]] int num_frames() const { return static_cast<int>(timestamps.size()); }
  [[nodiscard]] int num_points() const { return static_cast<int>(names.size()); }
  [[nodiscard]] const Keypoint& at(int frame, int k) const { return points[size_t(frame) * names.size() + k]; }
  [[nodiscard]] Keypoint& at(int frame, int k) { return points[size_t(frame) * names.size() + k]; }
};

/// A pixel that a dense detector assigned to a point of the body's surface.
struct DenseKeypoint {
  int face = 0;
  Eigen::Vector3f barycentric = Eigen::Vector3f(1, 0, 0);  ///< of the face's corners, sums to 1
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  float sigma_px = 1;  ///< standard deviation of the pixel
};

struct DenseSequence {
  std::vector<std::vector<DenseKeypoint>> frames;  ///< T
  std::vector<double> timestamps;                  ///< T seconds
  int image_width = 0, image_height = 0;
  [[nodiscard]] int num_frames() const { return static_cast<int>(frames.size()); }
};

/// COCO's 17 landmark names in order: nose, left_eye, right_eye, left_ear, right_ear, left_shoulder, …, right_ankle.
const std::vector<std::string>& CocoNames();

}  // namespace bodyloom
