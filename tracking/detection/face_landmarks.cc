// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/face_landmarks.h"

#include <cmath>
#include <limits>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/detection/inference/graph_executor.h"
#include "tracking/detection/inference/tflite_reader.h"
#include "tracking/detection/model_files.h"

namespace bodyloom {
namespace {

/// Around the points' upright rectangle, with the direction from right to left eye level.
PoseRegion RegionAround(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& eyes, double scale) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::max()), high = -low;
  for (const Eigen::Vector2d& point : points) {
    low = low.min(point.array());
    high = high.max(point.array());
  }
  return {.centre = ((low + high) / 2).matrix(),
          .side = scale * (high - low).maxCoeff(),
          .rotation = std::atan2(eyes.y(), eyes.x())};
}

}  // namespace

PoseRegion FaceRegionOfBody(std::span<const Eigen::Vector2d> points) {
  constexpr size_t kCount = 11, kLeftEye = 2, kRightEye = 5;
  BODYLOOM_CHECK(points.size() == kCount, "a body has 11 points of the face, got ", points.size());
  return RegionAround(points, points[kLeftEye] - points[kRightEye], 2);
}

PoseRegion FaceRegionOfPoints(std::span<const Eigen::Vector2d> points) {
  constexpr size_t kLeftCorner = 263, kRightCorner = 33;  // the eyes' outer ones
  BODYLOOM_CHECK(points.size() == kFaceNetworkLandmarks, "a face has 468 points, got ", points.size());
  return RegionAround(points, points[kLeftCorner] - points[kRightCorner], 1.5);
}

DetectedFace DecodeFace(std::span<const float> landmarks, float presence, const PoseRegion& region) {
  BODYLOOM_CHECK(landmarks.size() == 3 * size_t{kFaceNetworkLandmarks},
                 "the face network gives 468 x 3 landmarks, got ", landmarks.size());
  DetectedFace face;
  face.presence = 1 / (1 + std::exp(-double{presence}));
  face.region = region;
  for (size_t k = 0; k < kFaceNetworkLandmarks; ++k) {
    const float* raw = &landmarks[3 * k];
    face.points.push_back(region.ImageFromFraction(Eigen::Vector2d(raw[0], raw[1]) / kFaceNetworkSize));
    face.depth_px.push_back(raw[2] / kFaceNetworkSize * region.side);
  }
  return face;
}

FaceObservation FaceOf(const DetectedFace& face) {
  constexpr double kOfSide = 0.01, kOfPixels = 0.5;
  FaceObservation result;
  result.sigma_px = float(std::hypot(kOfSide * face.region.side, kOfPixels));
  for (size_t k = 0; k < kFacePoints; ++k) {
    const auto from = size_t(Face68Of468()[k]);
    const Eigen::Vector2d& point = face.points[from];
    result.points[k] = {float(point.x()), float(point.y()), float(face.presence)};
    result.depth_px[k] = float(face.depth_px[from]);
  }
  return result;
}

class FaceDetector::Network {
 public:
  explicit Network(const std::string& folder)
      : executor_(ReadImageNetwork(FindModelFile(kFaceLandmarkFile, folder), kFaceNetworkSize,
                                   {3 * kFaceNetworkLandmarks, 1})) {}
  GraphExecutor executor_;
};

FaceDetector::FaceDetector(const std::string& folder) : network_(std::make_unique<const Network>(folder)) {}
FaceDetector::~FaceDetector() = default;
FaceDetector::FaceDetector(FaceDetector&&) noexcept = default;
FaceDetector& FaceDetector::operator=(FaceDetector&&) noexcept = default;

DetectedFace FaceDetector::FaceIn(const Image& image, const PoseRegion& region) const {
  const std::vector<GraphTensor> outputs =
      network_->executor_.Run(CropRegion(image, region, kFaceNetworkSize, 1.0F / 255, 0));
  return DecodeFace(outputs[0].floats, outputs[1].floats[0], region);
}

}  // namespace bodyloom
