// SPDX-License-Identifier: Apache-2.0
/// Landmarks of a hand in an image, by two networks of MediaPipe.
///
/// The body's wrist, little finger and index give a region (HandRegionOfBody()), which a first network narrows
/// (HandRegionOfAxis()); the landmark network then looks twice, the second time at the region of its own first
/// landmarks (HandRegionOfPoints()). It takes a region as 224 × 224 pixels and gives 21 points (x, y, z in those
/// pixels; order: geometry/scene/hands_and_face.h), the probability that a hand is there, one that it is a right hand,
/// which is not used (the body tells the side), and the points in metres about the hand's middle.
///
/// A region is a square (pose_region.h) whose upward direction is that from wrist to fingers.
/// Source: MediaPipe, hand_landmarks_from_pose, hand_recrop_by_roi, hand_landmarks_to_roi, hand_landmark:
/// HandDetectionsFromPoseToRectsCalculator, AlignmentPointsRectsCalculator, HandLandmarksToRectCalculator,
/// RectTransformationCalculator, LandmarkProjectionCalculator, WorldLandmarkProjectionCalculator.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "geometry/scene/hands_and_face.h"
#include "render/image/image.h"
#include "tracking/detection/pose_region.h"

namespace bodyloom {

using HandPixels = std::array<Eigen::Vector2d, kHandPoints>;

/// With m = (2 · index + little finger) / 3 and a = m − wrist: centre m + 0.2 a, side 5.4 |a|.
PoseRegion HandRegionOfBody(const Eigen::Vector2d& wrist, const Eigen::Vector2d& little_finger,
                            const Eigen::Vector2d& index);

/// With a = middle − below: centre middle + 0.2 a, side 2 |a|.
PoseRegion HandRegionOfAxis(const Eigen::Vector2d& middle, const Eigen::Vector2d& below);

/// The hand's rectangle with its sides along and across wrist → (index + 2 · middle + ring) / 4, those nearest joints,
/// around the wrist, the thumb but its tip, and the two joints nearest to the wrist of each other finger; moved up by a
/// tenth of its height; side twice its longer one.
PoseRegion HandRegionOfPoints(const HandPixels& points);

inline constexpr int kHandNetworkSize = 224, kHandRegionNetworkSize = 256;

/// Outputs of the landmark network.
struct HandNetworkOutputs {
  std::span<const float> landmarks;  ///< 21 · 3
  float presence = 0;                ///< a probability already
  std::span<const float> world;      ///< 21 · 3, metres
};

struct DetectedHand {
  double presence = 0;  ///< probability that a hand is in the region; below ½ the other fields have no meaning
  PoseRegion region;    ///< input of the network
  HandPixels points{};  ///< pixels of the image
  /// Metres from the hand's middle: x right, y down, z away from the camera.
  std::array<Eigen::Vector3d, kHandPoints> world{};
};

/// Throws std::invalid_argument for spans of other sizes.
DetectedHand DecodeHand(const HandNetworkOutputs& outputs, const PoseRegion& region);

/// The hand of the last of two looks. Standard deviation of point k along an axis:
///   (s² (c² + (0.8 δ)²) + 0.8²)^½ pixels, s = a third of the region's side (about wrist to middle knuckle), c = 0.06
///   for the wrist and the joints nearest to it, then 0.08, 0.10 and 0.13 for the tips, δ = the median distance of the
///   two looks' points, relative to s.
/// Measured as the distance of a hand's points from the epipolar lines of the other of two cameras; the last term as
/// the change when pictures are made smaller (docs/lab/hands.md).
HandObservation HandOf(const DetectedHand& first, const DetectedHand& last);

/// Any number of threads may use one at once.
class HandDetector {
 public:
  /// Reads both networks from a folder, or where they are installed when it is empty (model_files.h). Throws
  /// std::runtime_error naming a file that is missing or not such a network.
  explicit HandDetector(const std::string& folder);
  ~HandDetector();
  HandDetector(HandDetector&&) noexcept;
  HandDetector& operator=(HandDetector&&) noexcept;

  /// The narrowed region of a hand in the region of HandRegionOfBody(); none when it is not valid.
  [[nodiscard]] std::optional<PoseRegion> Narrowed(const Image& image, const PoseRegion& region_of_body) const;
  /// The hand in a region, which may be empty: DetectedHand::presence.
  [[nodiscard]] DetectedHand HandIn(const Image& image, const PoseRegion& region) const;

 private:
  class Networks;
  std::unique_ptr<const Networks> networks_;
};

}  // namespace bodyloom
