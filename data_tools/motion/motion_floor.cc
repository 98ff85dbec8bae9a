// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "data_tools/motion/smpl_rest.h"
#include "geometry/check.h"

namespace bodyloom {
namespace {

constexpr double kSupportSpeed = 0.3, kLevelBand = 0.06, kFlatBand = 0.08, kFlatShare = 0.9, kLeastSupport_s = 0.25;

constexpr std::array<double, 24> kClearance = {
    0.11,  0.09,  0.09,         // pelvis, hips
    0.11,  0.055, 0.055,        // spine1, knees
    0.11,  0.08,  0.08,         // spine2, ankles
    0.11,  0.025, 0.025,        // spine3, toes
    0.06,  0.06,  0.06,  0.09,  // neck, collars, head
    0.05,  0.05,  0.04,  0.04,  // shoulders, elbows
    0.03,  0.03,  0.015, 0.015  // wrists, hands
};

double Percentile(std::vector<double> values, double share) {
  const auto nth = values.begin() + static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

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
      if (dt > 0 && (joints[after].row(j) - joints[before].row(j)).norm() < kSupportSpeed * dt) {
        support.push_back(all.back());
        floor.support_s += dt / (after - before);
      }
    }
  }
  BODYLOOM_CHECK(!all.empty(), "EstimateFloor: no frames");
  if (support.empty()) {
    floor.height_m = Percentile(all, 0.05);
    return floor;
  }
  const double low = Percentile(support, 0.05);
  std::vector<double> level;
  for (const double height : support) {
    if (height >= low && height <= low + kLevelBand) level.push_back(height);
  }
  floor.height_m = Percentile(level, 0.5);
  const auto flat = std::count_if(support.begin(), support.end(), [&](double height) {
    return std::abs(height - floor.height_m) <= kFlatBand;
  });
  floor.flat_share = static_cast<double>(flat) / static_cast<double>(support.size());
  floor.has_floor = floor.support_s >= kLeastSupport_s && floor.flat_share >= kFlatShare;
  return floor;
}

}  // namespace bodyloom
