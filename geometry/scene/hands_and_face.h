// SPDX-License-Identifier: Apache-2.0
/// 2D landmarks of a person's hands and face, beside those of the body (observations.h).
///
/// A hand has 21 points, in the order that OpenPose, COCO-WholeBody, Halpe and MediaPipe share (HandLandmarkNames(),
/// geometry/body/hand_skeleton.h): the wrist, then of thumb, index, middle, ring and little finger each the joint
/// nearest to the wrist, the next two and the tip. A face has the 68 points of 300-W (jaw from the right ear to the
/// left, brows, nose, eyes, lips), in the order that OpenPose, COCO-WholeBody and Halpe share; MediaPipe's 468 contain
/// them (Face68Of468()). Left and right are the person's.
/// Source: OpenPose doc/02_output.md; C. Sagonas et al., 300 Faces in-the-Wild Challenge, ICCV Workshops 2013;
/// MediaPipe face_mesh, canonical_face_model.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/body/hand_skeleton.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

inline constexpr int kFacePoints = 68;

struct HandObservation {
  std::array<Keypoint, kHandPoints> points{};  ///< pixels; missing as in a KeypointSequence
  /// Standard deviation of a point along each axis, pixels; 0: not known, as in detections of other programs.
  std::array<float, kHandPoints> sigma_px{};
  /// Metres about the hand's middle: x right, y down, z away from the camera; NaN: not known. In proportion to each
  /// other; the hand's size is a guess.
  std::array<Eigen::Vector3f, kHandPoints> metres = Unknown();

 private:
  static std::array<Eigen::Vector3f, kHandPoints> Unknown();
};

struct FaceObservation {
  std::array<Keypoint, kFacePoints> points{};  ///< pixels
  float sigma_px = 0;                          ///< as a hand's, for all points
  /// Depth of a point, pixels in the scale of the image, smaller is nearer, from an origin common to the face; NaN: not
  /// known. With the pixels it shows the head's rotation.
  std::array<float, kFacePoints> depth_px = Unknown();

 private:
  static std::array<float, kFacePoints> Unknown();
};

/// A person's hands and face in one frame; those that were not found are absent.
struct HandsAndFace {
  enum Side { kLeft = 0, kRight = 1 };
  std::array<std::optional<HandObservation>, 2> hands;  ///< by Side
  std::optional<FaceObservation> face;
  [[nodiscard]] bool empty() const { return !hands[kLeft] && !hands[kRight] && !face; }
};

/// Frames of one person, those of a KeypointSequence.
struct HandsAndFaceSequence {
  /// T; null: neither hands nor a face.
  std::vector<std::shared_ptr<const HandsAndFace>> frames;
  std::vector<double> timestamps;         ///< T seconds, strictly increasing
  int image_width = 0, image_height = 0;  ///< 0 when unknown
  [[nodiscard]] int num_frames() const { return static_cast<int>(frames.size()); }
  /// True if no frame has a hand or a face.
  [[nodiscard]] bool empty() const;
};

/// Indices of the face's 68 points among MediaPipe's 468, which have the same meaning (but for the jaw, where 300-W's
/// points follow the outline in the image, the nearest).
const std::array<int, kFacePoints>& Face68Of468();

/// Pairs of a face's points that lines join, to draw it.
std::span<const std::pair<int, int>> FaceLines();

}  // namespace bodyloom
