// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/detection/pose_landmarks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kWindowRadius = 3;
constexpr double kMinHeat = 0.5, kMaskThreshold = 0.5;

double Sigmoid(double logit) { return 1 / (1 + std::exp(-logit)); }

struct Refined {
  Eigen::Vector2d fraction;
  double heat = 0;
};

/// Landmark `k` at `fraction` of the crop, moved to the centre of its heatmap's window.
Refined RefineByHeatmap(std::span<const float> heatmaps, int k, const Eigen::Vector2d& fraction) {
  constexpr int n = kPoseHeatmapSize;
  // A place that is not a number compares false.
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

/// Bilinear value of probabilities on a grid whose point (column, row) lies at fraction column/256, row/256; 0 outside.
double MaskAt(std::span<const float> probability, const Eigen::Vector2d& fraction) {
  constexpr int n = kPoseNetworkSize;
  const Eigen::Vector2d at = fraction * n;
  const int x0 = int(std::floor(at.x())), y0 = int(std::floor(at.y()));
  const double ax = at.x() - x0, ay = at.y() - y0;
  const auto value = [probability](int x, int y) {
    return x < 0 || y < 0 || x >= n || y >= n ? 0.0 : double(probability[size_t(y) * n + x]);
  };
  return (1 - ay) * ((1 - ax) * value(x0, y0) + ax * value(x0 + 1, y0)) +
         ay * ((1 - ax) * value(x0, y0 + 1) + ax * value(x0 + 1, y0 + 1));
}

LabelImage MaskInImage(std::span<const float> logits, const PoseRegion& region, int image_width, int image_height) {
  std::vector<float> probability(logits.size());
  std::transform(logits.begin(), logits.end(), probability.begin(), [](float v) { return float(Sigmoid(v)); });
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  for (const Eigen::Vector2d corner :
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
  // Fractions change linearly along a row.
  const Eigen::Vector2d step = Eigen::Rotation2Dd(-region.rotation) * Eigen::Vector2d(1 / region.side, 0);
  for (int y = 0; y < mask.height; ++y) {
    const Eigen::Vector2d start = region.FractionFromImage({double(mask.x_begin), double(mask.y_begin + y)});
    for (int x = 0; x < mask.width; ++x) {
      mask.labels[size_t(y) * mask.width + x] = MaskAt(probability, start + x * step) >= kMaskThreshold ? 1 : 0;
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
  DetectedPose result{.presence = outputs.presence, .region = region};
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
