// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/hand_landmarks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "tracking/detection/inference/graph_executor.h"
#include "tracking/detection/inference/tflite_reader.h"
#include "tracking/detection/model_files.h"

namespace bodyloom {
namespace {

/// Indices of the landmark network's outputs.
enum HandOutput { kHandLandmarks, kHandPresence, kRightHand, kHandWorld };

constexpr double kShift = 0.1;  ///< of a region towards the fingers, in heights of the rectangle that it is made of

/// A square whose upward direction is `up`, moved along it by kShift · height.
PoseRegion Region(const Eigen::Vector2d& centre, const Eigen::Vector2d& up, double height, double side) {
  return {.centre = centre + kShift * height * up.normalized(), .side = side, .rotation = std::atan2(up.x(), -up.y())};
}

}  // namespace

PoseRegion HandRegionOfBody(const Eigen::Vector2d& wrist, const Eigen::Vector2d& little_finger,
                            const Eigen::Vector2d& index) {
  constexpr double kSide = 2.7;
  const Eigen::Vector2d middle = (2 * index + little_finger) / 3, axis = middle - wrist;
  const double height = 2 * axis.norm();
  return Region(middle, axis, height, kSide * height);
}

PoseRegion HandRegionOfAxis(const Eigen::Vector2d& middle, const Eigen::Vector2d& below) {
  const Eigen::Vector2d axis = middle - below;
  const double height = 2 * axis.norm();
  return Region(middle, axis, height, height);
}

PoseRegion HandRegionOfPoints(const HandPixels& points) {
  constexpr double kSide = 2;
  constexpr int kSteady[] = {0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18};
  const Eigen::Vector2d up = (points[5] + 2 * points[9] + points[13]) / 4 - points[0];
  const Eigen::Rotation2Dd turn(std::atan2(up.x(), -up.y()));
  Eigen::Array2d low = Eigen::Array2d::Zero(), high = low;  // about the wrist, along the region's axes
  for (const int k : kSteady) {
    const Eigen::Array2d place = (turn.inverse() * (points[size_t(k)] - points[0])).array();
    low = low.min(place);
    high = high.max(place);
  }
  const Eigen::Vector2d centre = points[0] + turn * ((low + high) / 2).matrix();
  return Region(centre, up, high.y() - low.y(), kSide * (high - low).maxCoeff());
}

DetectedHand DecodeHand(const HandNetworkOutputs& outputs, const PoseRegion& region) {
  constexpr size_t n = 3 * size_t{kHandPoints};
  BODYLOOM_CHECK(outputs.landmarks.size() == n && outputs.world.size() == n,
                 "the hand network gives 21 x 3 landmarks and 21 x 3 in metres, got ", outputs.landmarks.size(),
                 " and ", outputs.world.size());
  DetectedHand hand;
  hand.presence = outputs.presence;
  hand.region = region;
  const Eigen::Rotation2Dd turn(region.rotation);
  for (size_t k = 0; k < kHandPoints; ++k) {
    const float *raw = &outputs.landmarks[3 * k], *metres = &outputs.world[3 * k];
    hand.points[k] = region.ImageFromFraction(Eigen::Vector2d(raw[0], raw[1]) / kHandNetworkSize);
    hand.world[k] << turn * Eigen::Vector2d(metres[0], metres[1]), metres[2];
  }
  return hand;
}

HandObservation HandOf(const DetectedHand& first, const DetectedHand& last) {
  constexpr double kOfPoint[] = {0.06, 0.06, 0.08, 0.10, 0.13};  // wrist, then along a finger
  constexpr double kOfLooks = 0.8, kOfPixels = 0.8, kScaleOfSide = 1.0 / 3;
  const double scale = kScaleOfSide * last.region.side;
  std::array<double, kHandPoints> distances{};
  for (size_t k = 0; k < kHandPoints; ++k) distances[k] = (last.points[k] - first.points[k]).norm();
  std::nth_element(distances.begin(), distances.begin() + kHandPoints / 2, distances.end());
  const double looks = kOfLooks * distances[kHandPoints / 2];
  HandObservation hand;
  for (size_t k = 0; k < kHandPoints; ++k) {
    const double of_point = kOfPoint[k == 0 ? 0 : 1 + (k - 1) % 4] * scale;
    hand.points[k] = {float(last.points[k].x()), float(last.points[k].y()), float(last.presence)};
    hand.sigma_px[k] = float(std::sqrt(of_point * of_point + looks * looks + kOfPixels * kOfPixels));
    hand.metres[k] = last.world[k].cast<float>();
  }
  return hand;
}

class HandDetector::Networks {
 public:
  explicit Networks(const std::string& folder)
      : region_(ReadImageNetwork(FindModelFile(kHandRegionFile, folder), kHandRegionNetworkSize, {4})),
        landmarks_(ReadImageNetwork(FindModelFile(kHandLandmarkFile, folder), kHandNetworkSize,
                                    {3 * kHandPoints, 1, 1, 3 * kHandPoints}),
                   {}, {kHandLandmarks, kHandPresence, kHandWorld}) {}

  GraphExecutor region_, landmarks_;
};

HandDetector::HandDetector(const std::string& folder) : networks_(std::make_unique<const Networks>(folder)) {}
HandDetector::~HandDetector() = default;
HandDetector::HandDetector(HandDetector&&) noexcept = default;
HandDetector& HandDetector::operator=(HandDetector&&) noexcept = default;

std::optional<PoseRegion> HandDetector::Narrowed(const Image& image, const PoseRegion& region_of_body) const {
  constexpr int n = kHandRegionNetworkSize;
  const std::vector<GraphTensor> outputs = networks_->region_.Run(CropRegion(image, region_of_body, n, 1.0F / 255, 0));
  const SharedNumbers<float>& p = outputs[0].floats;
  const PoseRegion region = HandRegionOfAxis(region_of_body.ImageFromFraction(Eigen::Vector2d(p[0], p[1]) / n),
                                             region_of_body.ImageFromFraction(Eigen::Vector2d(p[2], p[3]) / n));
  return region.IsValid() ? std::optional(region) : std::nullopt;
}

DetectedHand HandDetector::HandIn(const Image& image, const PoseRegion& region) const {
  const std::vector<GraphTensor> outputs =
      networks_->landmarks_.Run(CropRegion(image, region, kHandNetworkSize, 1.0F / 255, 0));
  return DecodeHand({.landmarks = outputs[0].floats, .presence = outputs[1].floats[0], .world = outputs[2].floats},
                    region);
}

}  // namespace bodyloom
