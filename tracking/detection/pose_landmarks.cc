// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/pose_landmarks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kWindowRadius = 3;
constexpr double kMinHeat = 0.5;
constexpr float kMaskThreshold = 0.5F;

double Sigmoid(double logit) { return 1 / (1 + std::exp(-logit)); }

struct Refined {
  Eigen::Vector2d fraction;
  double heat = 0;
};

/// Landmark `k` at `fraction` of the crop, moved to the centre of its heatmap's window.
Refined RefineByHeatmap(std::span<const float> heatmaps, int k, const Eigen::Vector2d& fraction) {
  constexpr int n = kPoseHeatmapSize;
  // NaN compares false.
  if (!(fraction.x() > -1 && fraction.x() < 2 && fraction.y() > -1 && fraction.y() < 2)) return {fraction, 0};
  const int column = int(std::trunc(n * fraction.x())), row = int(std::trunc(n * fraction.y()));
  if (column < 0 || row < 0 || column >= n || row >= n) return {fraction, 0};
  double sum = 0, peak = 0;
  Eigen::Vector2d weighted = Eigen::Vector2d::Zero();
  for (int y = std::max(0, row - kWindowRadius); y <= std::min(n - 1, row + kWindowRadius); ++y) {
    for (int x = std::max(0, column - kWindowRadius); x <= std::min(n - 1, column + kWindowRadius); ++x) {
      const double p = Sigmoid(heatmaps[(size_t(y) * n + x) * kPoseNetworkLandmarks + k]);
      sum += p;
      weighted += p * Eigen::Vector2d(x, y);
      peak = std::max(peak, p);
    }
  }
  if (peak < kMinHeat) return {fraction, peak};
  return {weighted / sum / n, peak};
}

/// The network's mask as probabilities, interpolated bilinearly, 0 outside. Pixel (column, row) lies at fraction
/// column/256, row/256 of the crop.
class MaskSampler {
 public:
  explicit MaskSampler(std::span<const float> logits) : values_(size_t{kSide} * kSide, 0.0F) {
    for (int y = 0; y < kSize; ++y) {
      std::transform(&logits[size_t(y) * kSize], &logits[size_t(y) * kSize] + kSize,
                     &values_[size_t(y + 1) * kSide + 1], [](float v) { return float(Sigmoid(v)); });
    }
  }

  /// Probability at a column and a row of the mask.
  [[nodiscard]] float At(float x, float y) const {
    x = std::clamp(x, -1.0F, float(kSize)) + 1;
    y = std::clamp(y, -1.0F, float(kSize)) + 1;
    const int x0 = int(x), y0 = int(y);
    const float ax = x - float(x0), ay = y - float(y0);
    const float* at = &values_[size_t(y0) * kSide + size_t(x0)];
    const float upper = at[0] + ax * (at[1] - at[0]), lower = at[kSide] + ax * (at[kSide + 1] - at[kSide]);
    return upper + ay * (lower - upper);
  }

 private:
  /// One pixel of zeros before the mask, two behind, to which positions outside are clamped.
  static constexpr int kSize = kPoseNetworkSize, kSide = kSize + 3;
  std::vector<float> values_;
};

LabelImage MaskInImage(std::span<const float> logits, const PoseRegion& region, int image_width, int image_height) {
  const MaskSampler sampler(logits);
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(1, 1)}) {
    const Eigen::Array2d pixel = region.ImageFromFraction(corner).array();
    low = low.min(pixel);
    high = high.max(pixel);
  }
  low = low.floor().max(0);
  high = (high.ceil() + 1).min(Eigen::Array2d(image_width, image_height));
  LabelImage mask;
  if ((high <= low).any()) return mask;
  mask.x_begin = int(low.x());
  mask.y_begin = int(low.y());
  mask.width = int(high.x() - low.x());
  mask.height = int(high.y() - low.y());
  mask.labels.resize(size_t(mask.width) * mask.height);
  // Places in the network's mask change linearly along a row.
  const Eigen::Vector2f step =
      (Eigen::Rotation2Dd(-region.rotation) * Eigen::Vector2d(kPoseNetworkSize / region.side, 0)).cast<float>();
  for (int y = 0; y < mask.height; ++y) {
    const Eigen::Vector2d pixel(mask.x_begin, mask.y_begin + y);
    const Eigen::Vector2f start = (kPoseNetworkSize * region.FractionFromImage(pixel)).cast<float>();
    uint8_t* to = &mask.labels[size_t(y) * mask.width];
    for (int x = 0; x < mask.width; ++x) {
      const float along = float(x);
      to[x] = sampler.At(start.x() + along * step.x(), start.y() + along * step.y()) >= kMaskThreshold ? 1 : 0;
    }
  }
  return mask;
}

}  // namespace

DetectedPose DecodePose(const PoseNetworkOutputs& outputs, const PoseRegion& region, int image_width,
                        int image_height) {
  constexpr size_t n = kPoseNetworkLandmarks, mask_size = size_t(kPoseNetworkSize) * kPoseNetworkSize;
  BODYLOOM_CHECK(outputs.landmarks.size() == n * 5 && outputs.world.size() == n * 3 &&
                     outputs.heatmaps.size() == n * kPoseHeatmapSize * kPoseHeatmapSize &&
                     (outputs.mask.empty() || outputs.mask.size() == mask_size),
                 "the pose network gives 39 x 5 landmarks, 39 x 3 in metres, 64 x 64 x 39 heatmaps and 256 x 256 mask "
                 "logits or none, got ",
                 outputs.landmarks.size(), ", ", outputs.world.size(), ", ", outputs.heatmaps.size(), " and ",
                 outputs.mask.size());
  DetectedPose result;
  result.presence = outputs.presence;
  result.region = region;
  const Eigen::Rotation2Dd turn(region.rotation);
  for (int k = 0; k < 35; ++k) {
    const float* raw = &outputs.landmarks[size_t(k) * 5];
    const Refined refined = RefineByHeatmap(outputs.heatmaps, k, Eigen::Vector2d(raw[0], raw[1]) / kPoseNetworkSize);
    const Eigen::Vector2d pixel = region.ImageFromFraction(refined.fraction);
    if (k == 33) {
      result.hips = pixel;
    } else if (k == 34) {
      result.rim = pixel;
    } else {
      const float* metres = &outputs.world[size_t(k) * 3];
      PoseLandmark& landmark = result.landmarks[k];
      landmark = {.pixel = pixel,
                  .depth_px = raw[2] / kPoseNetworkSize * region.side,
                  .visibility = Sigmoid(raw[3]),
                  .heat = refined.heat};
      landmark.world << turn * Eigen::Vector2d(metres[0], metres[1]), metres[2];
    }
  }
  if (!outputs.mask.empty()) result.mask = MaskInImage(outputs.mask, region, image_width, image_height);
  return result;
}

double PoseDistance(const DetectedPose& a, const DetectedPose& b) {
  double sum = 0;
  for (size_t k = 0; k < a.landmarks.size(); ++k) sum += (a.landmarks[k].pixel - b.landmarks[k].pixel).norm();
  return sum / double(a.landmarks.size()) / std::min(a.region.side, b.region.side);
}

}  // namespace bodyloom
