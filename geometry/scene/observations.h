// SPDX-License-Identifier: Apache-2.0
/// Observations of a clip: 2D keypoints, dense surface keypoints and part labels, one person, one camera.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/scene/label_image.h"

namespace bodyloom {

/// A detected 2D landmark. Missing if confidence <= 0 or a coordinate is not finite.
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
  int image_width = 0, image_height = 0;  ///< 0 when unknown
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
  /// The two components of sigma_px, when known: noise of the labels in units of a chart, and noise of the pixels. A
  /// detector's error lies on the surface, so in the image it is large where the surface faces the camera and small in
  /// foreshortened directions; the tracker models this if uv_sigma > 0. 0: unknown, sigma_px in every direction.
  double uv_sigma = 0, pixel_sigma_px = 0;
  std::vector<double> timestamps;  ///< T seconds
  int image_width = 0, image_height = 0;
  [[nodiscard]] int num_frames() const { return static_cast<int>(frames.size()); }
};

/// Part labels of the pixels of each frame: DensePose's part indices, or a mask.
///
/// Labels and the body's charts are matched by *parts*, numbers that the caller assigns: a pixel with label l shows
/// part part_of_label[l], and a face of chart c (BodyModelData::face_part) belongs to part part_of_chart[c]. A part may
/// hold several charts (upper arm outside and inside), and several labels; Merge() joins two parts for both. Initially
/// the mapping is the identity, so labels 1–24 are the charts 1–24.
///   part 0     background: the pixel does not show the person; a chart of part 0 is never labelled and has no term
///   part 255   unknown: nothing is known about the pixel (nor about the chart)
/// A mask has one label for the whole person: AsMask().
struct PartLabelSequence {
  static constexpr uint8_t kBackground = 0, kUnknown = 255;
  std::vector<PackedLabels> frames;       ///< T; empty for a frame without a detected person
  std::vector<double> timestamps;         ///< T seconds, strictly increasing
  int image_width = 0, image_height = 0;  ///< pixels, required; rectangles lie inside the image
  std::array<uint8_t, 256> part_of_label = Identity(), part_of_chart = Identity();
  [[nodiscard]] int num_frames() const { return static_cast<int>(frames.size()); }
  [[nodiscard]] uint8_t PartAt(int frame, int x, int y) const { return part_of_label[frames[frame].At(x, y)]; }
  /// Returns the part of every pixel of a frame's rectangle.
  [[nodiscard]] LabelImage PartsOf(int frame) const;
  /// Reassigns labels and charts of `part` to `into`.
  void Merge(uint8_t part, uint8_t into);
  /// Assigns every label from 1 to 254 and every chart to part 1.
  void AsMask();

 private:
  static std::array<uint8_t, 256> Identity();
};

/// COCO's 17 landmark names in order: nose, left_eye, right_eye, left_ear, right_ear, left_shoulder, …, right_ankle.
const std::vector<std::string>& CocoNames();

/// Error "path: …" for readable input that shows nobody or from which nothing could be estimated, so that callers of
/// many clips can distinguish it from a file that cannot be used.
class NoPersonFound : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace bodyloom
