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

/// The network's mask as probabilities, interpolated bilinearly, 0 outside, against the threshold. Pixel (column, row)
/// lies at fraction column/256, row/256 of the crop.
///
/// Most cells of four pixels lie on one side of the threshold with all of them; nothing is interpolated there, and the
/// distance to the next cell that is not so says how far.
class MaskSampler {
 public:
  explicit MaskSampler(std::span<const float> logits)
      : logits_(logits), values_(size_t{kSide} * kSide, 0.0F), distance_(size_t{kSide} * kSide) {
    for (int y = 0; y < kSize; ++y) std::fill_n(&values_[size_t(y + 1) * kSide + 1], kSize, kNotYet);
    FindSides();
    FindDistances();
  }

  /// 1 at `count` places from `start` (column, row) on, `step` apart, where the probability reaches the threshold.
  void ReadRow(const Eigen::Vector2f& start, const Eigen::Vector2f& step, int count, uint8_t* to) {
    const float longest = std::max(step.cwiseAbs().maxCoeff(), 1e-6F);
    for (int i = 0; i < count;) {
      const float along = float(i);
      const Place place = PlaceOf(start.x() + along * step.x(), start.y() + along * step.y());
      const int distance = distance_[place.cell];
      if (distance == 0) {
        to[i++] = At(place) >= kMaskThreshold ? 1 : 0;
        continue;
      }
      constexpr float kRounding = 0.01F;
      const int more = int(std::max(0.0F, (float(distance - 1) - kRounding) / longest));
      const int end = std::min(count, i + 1 + more);
      std::fill(to + i, to + end, sides_[place.cell]);
      i = end;
    }
  }

 private:
  /// One pixel of zeros before the mask, two behind, to which positions outside are clamped.
  static constexpr int kSize = kPoseNetworkSize, kSide = kSize + 3, kCells = kSide - 1;
  static constexpr float kNotYet = -1;
  static constexpr uint8_t kBothSides = 2, kFarthest = 200;  // cells
  struct Place {
    size_t cell;
    float ax, ay;
  };

  static Place PlaceOf(float x, float y) {
    x = std::clamp(x, -1.0F, float(kSize)) + 1;
    y = std::clamp(y, -1.0F, float(kSize)) + 1;
    const int x0 = int(x), y0 = int(y);
    return {size_t(y0) * kSide + size_t(x0), x - float(x0), y - float(y0)};
  }

  float At(const Place& place) {
    const float upper_left = Node(place.cell), lower_left = Node(place.cell + kSide);
    const float upper = upper_left + place.ax * (Node(place.cell + 1) - upper_left);
    const float lower = lower_left + place.ax * (Node(place.cell + kSide + 1) - lower_left);
    return upper + place.ay * (lower - upper);
  }

  float Node(size_t i) {
    float& value = values_[i];
    if (value == kNotYet) value = float(Sigmoid(logits_[(i / kSide - 1) * kSize + i % kSide - 1]));
    return value;
  }

  /// Of each cell, by the node before it in both directions.
  void FindSides() {
    constexpr float kClear = 1e-5F;  // a logit; nearer to 0 rounding may decide
    std::vector<uint8_t> nodes(size_t{kSide} * kSide, 0);
    for (int y = 0; y < kSize; ++y) {
      const float* from = &logits_[size_t(y) * kSize];
      uint8_t* to = &nodes[size_t(y + 1) * kSide + 1];
      // NaN compares false.
      for (int x = 0; x < kSize; ++x) to[x] = from[x] >= kClear ? 1 : from[x] <= -kClear ? 0 : kBothSides;
    }
    sides_.assign(size_t{kSide} * kSide, 0);
    for (size_t i = 0; i < size_t{kCells} * kSide - 1; ++i) {
      const uint8_t all = nodes[i] & nodes[i + 1] & nodes[i + kSide] & nodes[i + kSide + 1];
      const uint8_t any = nodes[i] | nodes[i + 1] | nodes[i + kSide] | nodes[i + kSide + 1];
      sides_[i] = all == any ? all : kBothSides;
    }
  }

  /// Of each cell, in cells along rows, columns and diagonals: to the nearest one that has both sides. A pass down
  /// finds the nearest above and to the left, one up those below and to the right. A row has a byte more than cells,
  /// which is never nearer.
  void FindDistances() {
    for (size_t i = 0; i < distance_.size(); ++i) distance_[i] = sides_[i] == kBothSides ? 0 : kFarthest;
    for (int row = 0; row < kCells; ++row) PassRow(row, row - 1, 1);
    for (int row = kCells; row-- > 0;) PassRow(row, row + 1 < kCells ? row + 1 : -1, -1);
  }

  /// Distances in a row by way of another row (none: −1) and of the cell that comes before in this direction.
  void PassRow(int row, int other, int direction) {
    uint8_t* here = &distance_[size_t(row) * kSide];
    if (other >= 0) {
      const uint8_t* there = &distance_[size_t(other) * kSide];
      for (int i = 0; i < kCells; ++i) {
        const uint8_t nearest = std::min({there[std::max(i - 1, 0)], there[i], there[i + 1]});
        here[i] = std::min<uint8_t>(here[i], nearest + 1);
      }
    }
    int last = kFarthest;
    for (int k = 0; k < kCells; ++k) {
      const int i = direction > 0 ? k : kCells - 1 - k;
      last = std::min<int>(here[i], last + 1);
      here[i] = uint8_t(last);
    }
  }

  std::span<const float> logits_;
  std::vector<float> values_;  ///< kNotYet: not computed yet
  std::vector<uint8_t> sides_, distance_;
};

LabelImage MaskInImage(std::span<const float> logits, const PoseRegion& region, int image_width, int image_height) {
  MaskSampler sampler(logits);
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
    sampler.ReadRow(start, step, mask.width, &mask.labels[size_t(y) * mask.width]);
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
