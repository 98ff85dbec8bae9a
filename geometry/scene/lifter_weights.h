// SPDX-License-Identifier: Apache-2.0
/// Architecture and weights of the lifter, a small temporal network from the 2D landmarks of a clip to 3D landmarks
/// with their uncertainty; trained in neural/lifter, evaluated in tracking/initialise.
///
/// x_t (num_inputs) → h = A ∗ x (kernel 3 over time, dilation 1) → blocks h ← h + M silu(D ∗ norm(h)) with D of
/// kernel 3 and the block's dilation → y = O norm(h). norm is over the channels of one frame, with scale and shift;
/// beyond the ends of a clip everything is zero. One frame's output y holds, in this order (LifterOutput):
///   torso landmarks     9 × (x, y, z, log σ_xy, log σ_z)
///   four limbs          3 logits, then 3 hypotheses × its landmarks × (x, y, z, log σ_xy, log σ_z)
///   world up            x, y, z, log σ
///   ground contact      logits of left and right foot
/// Positions are relative to the mid-hip, in the axes of a camera that looks at the body's middle (tracking/initialise/
/// lifter_input.h), in units of the body's torso + leg length; σ_xy is across that view, σ_z along it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

/// Layout of the network's output of one frame.
struct LifterOutput {
  static constexpr int kPoints = 21;     ///< landmarks: CocoNames(), big toes, heels (LifterPointNames())
  static constexpr int kHypotheses = 3;  ///< hypotheses of each limb
  static constexpr int kPerPoint = 5;    ///< x, y, z, log σ_xy, log σ_z
  static constexpr int kLimbs = 4;       ///< left arm, right arm, left leg, right leg
  static constexpr std::array<int, 9> kTorso = {0, 1, 2, 3, 4, 5, 6, 11, 12};  ///< face, shoulders, hips
  /// Landmarks of a limb that move together: elbow, wrist | knee, ankle, big toe, heel.
  static std::span<const int> LimbPoints(int limb);
  static constexpr int TorsoOffset(int i) { return kPerPoint * i; }
  static constexpr int kTorsoSize = kPerPoint * static_cast<int>(kTorso.size());
  static constexpr int kArmSize = kHypotheses * (1 + 2 * kPerPoint), kLegSize = kHypotheses * (1 + 4 * kPerPoint);
  static constexpr int LogitOffset(int limb) {
    return kTorsoSize + (limb < 2 ? limb * kArmSize : 2 * kArmSize + (limb - 2) * kLegSize);
  }
  static int PointOffset(int limb, int hypothesis, int i) {
    const int n = static_cast<int>(LimbPoints(limb).size());
    return LogitOffset(limb) + kHypotheses + kPerPoint * (hypothesis * n + i);
  }
  static constexpr int kUp = kTorsoSize + 2 * kArmSize + 2 * kLegSize;
  static constexpr int kContact = kUp + 4;
  static constexpr int kSize = kContact + 2;
};

struct LifterWeights {
  struct Block {
    int dilation = 1;
    Eigen::VectorXf norm_scale, norm_shift;  ///< C
    RowMatrixXf dilated;                     ///< C × 3C: columns of the earlier, the same and the later frame
    Eigen::VectorXf dilated_bias;            ///< C
    RowMatrixXf mix;                         ///< C × C
    Eigen::VectorXf mix_bias;                ///< C
  };
  RowMatrixXf input;           ///< C × 3·num_inputs, columns as in Block::dilated
  Eigen::VectorXf input_bias;  ///< C
  std::vector<Block> blocks;
  Eigen::VectorXf norm_scale, norm_shift;  ///< C
  RowMatrixXf output;                      ///< LifterOutput::kSize × C
  Eigen::VectorXf output_bias;
  std::string recipe;  ///< how it was trained: command, seed, data, one line each

  [[nodiscard]] int num_inputs() const { return static_cast<int>(input.cols()) / 3; }
  [[nodiscard]] int width() const { return static_cast<int>(input.rows()); }
  [[nodiscard]] size_t num_parameters() const;
  /// Number of frames on either side that an output depends on.
  [[nodiscard]] int reach() const;
  /// False with the reason when sizes contradict each other or a number is not finite.
  bool IsValid(std::string* why) const;
};

}  // namespace bodyloom
