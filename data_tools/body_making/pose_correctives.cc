// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/pose_correctives.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr int kThumbOfCorrectives = 4;  // in FingerNames()
/// Growth of a joint at a right angle in the middle of its step, which makes up for flesh that the fold swallows.
constexpr double kSwelling = 0.12;
constexpr double kDamping = 0.03;  // of the inverse of blended rotations
constexpr double kRidgePerSample = 0.003;
constexpr double kSmallestBlock_m = 1e-4;
constexpr double kFlexionDegree = M_PI / 180;

std::vector<Matrix3d> SampleRotations(int i, const Matrix3d& axes) {
  std::vector<double> flexion_deg = {-15, 15, 30, 45, 60, 75, 90, 105}, radial_deg = {0};
  if (i % 3 == 0) radial_deg = {-20, 0, 20};
  if (i == 3 * kThumbOfCorrectives) {
    flexion_deg = {-20, 0, 20, 40};
    radial_deg = {-20, 1, 20, 40, 60};
  }
  std::vector<Matrix3d> rotations;
  for (const double flexion : flexion_deg) {
    for (const double radial : radial_deg) {
      rotations.push_back(
          RotationFromAxisAngle(axes.col(0) * flexion * kFlexionDegree + axes.col(1) * radial * kFlexionDegree));
    }
  }
  return rotations;
}

/// The 3×9 block of a vertex at `x` from joint i, of which it follows the share `weight`: least squares over
/// `rotations` of the offset whose blend ((1 − w) I + w R)(x + offset) lies where R turned by the share w of its angle
/// takes x.
class CorrectiveFit {
 public:
  explicit CorrectiveFit(std::vector<Matrix3d> rotations) : rotations_(std::move(rotations)) {
    features_.resize(9, static_cast<Eigen::Index>(rotations_.size()));
    for (size_t s = 0; s < rotations_.size(); ++s) {
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> entries = rotations_[s] - Matrix3d::Identity();
      features_.col(static_cast<Eigen::Index>(s)) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(entries.data());
      axis_angles_.emplace_back(AxisAngleFromRotation(rotations_[s]));
    }
    const auto samples = static_cast<double>(rotations_.size());
    normal_.compute(features_ * features_.transpose() +
                    kRidgePerSample * samples * Eigen::Matrix<double, 9, 9>::Identity());
  }

  [[nodiscard]] CorrectiveBlock Block(int joint, const Vector3d& x, double weight) const {
    Eigen::Matrix<double, 9, 3> right = Eigen::Matrix<double, 9, 3>::Zero();
    for (size_t s = 0; s < rotations_.size(); ++s) {
      const Matrix3d blend = (1 - weight) * Matrix3d::Identity() + weight * rotations_[s];
      const double swell = 1 + kSwelling * 4 * weight * (1 - weight) * (1 - std::cos(axis_angles_[s].norm()));
      const Vector3d missing = swell * (RotationFromAxisAngle(weight * axis_angles_[s]) * x) - blend * x;
      const Matrix3d damped = blend.transpose() * blend + kDamping * Matrix3d::Identity();
      right +=
          features_.col(static_cast<Eigen::Index>(s)) * damped.ldlt().solve(blend.transpose() * missing).transpose();
    }
    const Eigen::Matrix<double, 9, 3> solution = normal_.solve(right);
    CorrectiveBlock block;
    block.joint = joint;
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 9; ++k) {
        block.values[9 * c + k] =
            static_cast<float>(kCorrectiveUnit_m * std::round(solution(k, c) / kCorrectiveUnit_m));
      }
    }
    return block;
  }

 private:
  std::vector<Matrix3d> rotations_;
  std::vector<Vector3d> axis_angles_;
  Eigen::Matrix<double, 9, Eigen::Dynamic> features_;
  Eigen::LDLT<Eigen::Matrix<double, 9, 9>> normal_;
};

}  // namespace

std::map<int, std::vector<CorrectiveBlock>> FitFingerCorrectives(const BodyModelData& body, const HandSkeleton& axes,
                                                                 int first_joint,
                                                                 const std::array<Vector3d, kHandJoints>& places,
                                                                 const std::vector<WeightedIndices>& weights,
                                                                 const std::vector<int>& left_vertices) {
  std::map<int, std::vector<CorrectiveBlock>> blocks;
  for (int i = 0; i < kHandJoints; ++i) {
    const CorrectiveFit fit(SampleRotations(i, axes.axes[i]));
    for (size_t r = 0; r < left_vertices.size(); ++r) {
      double share = 0;
      for (const auto& [joint, weight] : weights[r]) {
        const int j = joint - first_joint;
        if (j >= i && j < i - i % 3 + 3) share += weight;
      }
      if (share < 1e-3 || share > 1 - 1e-3) continue;
      const int v = left_vertices[r];
      const Vector3d x = body.v_template.row(v).transpose() - places[size_t(i)];
      const CorrectiveBlock block = fit.Block(first_joint + i, x, share);
      if (std::any_of(block.values.begin(), block.values.end(),
                      [](float value) { return std::abs(value) >= kSmallestBlock_m; })) {
        blocks[v].push_back(block);
      }
    }
  }
  return blocks;
}

void AddCorrectives(const RefinedCage& refined, const std::vector<int>& joint_mirror,
                    const std::map<int, std::vector<CorrectiveBlock>>& left, int keep_below, PoseCorrectives* all) {
  std::vector<std::vector<CorrectiveBlock>> added(refined.mirror.size());
  for (const auto& [v, blocks] : left) {
    added[size_t(v)] = blocks;
    const auto other = size_t(refined.mirror[size_t(v)]);
    if (other == size_t(v)) continue;
    for (const CorrectiveBlock& block : blocks) {
      added[other].push_back(MirrorCorrective(block, joint_mirror[size_t(block.joint)]));
    }
    std::sort(added[other].begin(), added[other].end(), [](const auto& a, const auto& b) { return a.joint < b.joint; });
  }
  PoseCorrectives whole;
  whole.begin.push_back(0);
  const auto append = [&](int joint, const float* values) {
    whole.joint.push_back(joint);
    whole.block.insert(whole.block.end(), values, values + 27);
  };
  for (size_t v = 0; v < added.size(); ++v) {
    for (int k = all->begin.empty() ? 0 : all->begin[v]; !all->begin.empty() && k < all->begin[v + 1]; ++k) {
      if (all->joint[size_t(k)] < keep_below) append(all->joint[size_t(k)], &all->block[size_t{27} * size_t(k)]);
    }
    for (const CorrectiveBlock& block : added[v]) append(block.joint, block.values.data());
    whole.begin.push_back(static_cast<int>(whole.joint.size()));
  }
  *all = std::move(whole);
}

}  // namespace bodyloom
