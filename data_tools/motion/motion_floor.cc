// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "data_tools/motion/smpl_rest.h"
#include "geometry/base/check.h"
#include "geometry/base/percentile.h"

namespace bodyloom {
namespace {

constexpr double kSupportSpeed = 0.8, kSupportVerticalSpeed = 0.2;
constexpr double kLevelBand = 0.06, kFlatBand = 0.08, kFlatShare = 0.9, kMinSupport_s = 0.1;

constexpr std::array<double, 24> kClearance = {
    0.10, 0.09,  0.09,         // pelvis, hips
    0.08, 0.05,  0.05,         // spine1, knees
    0.08, 0.073, 0.073,        // spine2, ankles
    0.08, 0.01,  0.01,         // spine3, toes
    0.05, 0.05,  0.05,  0.09,  // neck, collars, head
    0.06, 0.06,  0.04,  0.04,  // shoulders, elbows
    0.03, 0.03,  0.02,  0.02   // wrists, hands
};

}  // namespace

double JointClearance(int j) {
  BODYLOOM_CHECK(j >= 0 && j < 24, "joint ", j, " of 24");
  return kClearance[j];
}

double LowestPoint(const MatrixX3d& joints, int* joint) {
  BODYLOOM_CHECK(joints.rows() == 24, joints.rows(), " joints, expected 24");
  int lowest = 0;
  for (int j = 1; j < 24; ++j) {
    if (joints(j, 1) - kClearance[j] < joints(lowest, 1) - kClearance[lowest]) lowest = j;
  }
  if (joint != nullptr) *joint = lowest;
  return joints(lowest, 1) - kClearance[lowest];
}

FloorEstimate EstimateFloor(std::span<const Motion> pieces) {
  std::vector<double> all, support;
  FloorEstimate floor;
  for (const Motion& piece : pieces) {
    BODYLOOM_CHECK(piece.poses.cols() == 72 && piece.up == Motion::Up::kY, "EstimateFloor: ", piece.poses.cols() / 3,
                   " joints, expected 24 in a world with y up");
    const std::vector<MatrixX3d> joints = PoseSmplJoints(piece);
    const int T = piece.num_frames();
    for (int t = 0; t < T; ++t) {
      int j = 0;
      all.push_back(LowestPoint(joints[t], &j));
      const int before = std::max(t - 1, 0), after = std::min(t + 1, T - 1);
      const double dt = piece.timestamps[after] - piece.timestamps[before];
      const Eigen::RowVector3d step = joints[after].row(j) - joints[before].row(j);
      if (dt > 0 && step.norm() < kSupportSpeed * dt && std::abs(step.y()) < kSupportVerticalSpeed * dt) {
        support.push_back(all.back());
        floor.support_s += dt / (after - before);
      }
    }
  }
  BODYLOOM_CHECK(!all.empty(), "EstimateFloor: no frames");
  if (support.empty()) {
    floor.height_m = Percentile(all, 5);
    return floor;
  }
  std::sort(support.begin(), support.end());
  const auto band_end = [&support](size_t i) {
    return std::upper_bound(support.begin(), support.end(), support[i] + kLevelBand) - support.begin();
  };
  const auto median_of_band = [&](size_t i) { return support[(i + band_end(i)) / 2]; };
  size_t densest = 0;
  for (size_t i = 0; i < support.size(); ++i) {
    if (band_end(i) - i > band_end(densest) - densest) densest = i;
  }
  floor.height_m = median_of_band(densest);
  const auto flat = std::count_if(support.begin(), support.end(),
                                  [&](double height) { return std::abs(height - floor.height_m) <= kFlatBand; });
  floor.flat_share = static_cast<double>(flat) / static_cast<double>(support.size());
  floor.has_floor = floor.support_s >= kMinSupport_s && floor.flat_share >= kFlatShare;
  if (!floor.has_floor)
    floor.height_m = median_of_band(static_cast<size_t>(0.05 * static_cast<double>(support.size())));
  return floor;
}

}  // namespace bodyloom
