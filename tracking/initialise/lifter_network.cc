// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/lifter_network.h"

#include <algorithm>
#include <cmath>

#include "geometry/check.h"

namespace bodyloom {
namespace {

constexpr float kNormEpsilon = 1e-5F;  // LibTorch's LayerNorm

/// Frames are worked on in strips whose rows stay in the second-level cache.
constexpr Eigen::Index kStrip = 96;

/// out(t) = bias + Σ_k W_k x(t + (k − 1) dilation), k = 0, 1, 2; x is zero outside.
RowMatrixXf Convolve(const RowMatrixXf& x, const RowMatrixXf& weight, const Eigen::VectorXf& bias, int dilation) {
  const Eigen::Index T = x.rows(), C = x.cols();
  RowMatrixXf out(T, weight.rows());
  for (Eigen::Index begin = 0; begin < T; begin += kStrip) {
    const Eigen::Index end = std::min(T, begin + kStrip);
    out.middleRows(begin, end - begin).rowwise() = bias.transpose();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Index shift = Eigen::Index{k - 1} * dilation;
      const Eigen::Index from = std::max(begin, -shift), to = std::min(end, T - shift);
      if (from >= to) continue;
      out.middleRows(from, to - from).noalias() +=
          x.middleRows(from + shift, to - from) * weight.middleCols(k * C, C).transpose();
    }
  }
  return out;
}

/// Each row to mean 0 and variance 1, then scale and shift.
RowMatrixXf NormaliseFrames(const RowMatrixXf& x, const Eigen::VectorXf& scale, const Eigen::VectorXf& shift) {
  RowMatrixXf out(x.rows(), x.cols());
  for (Eigen::Index t = 0; t < x.rows(); ++t) {
    const float mean = x.row(t).mean();
    out.row(t) = x.row(t).array() - mean;
    const float inverse = 1 / std::sqrt(out.row(t).squaredNorm() / static_cast<float>(x.cols()) + kNormEpsilon);
    out.row(t) = out.row(t).cwiseProduct((inverse * scale).transpose()) + shift.transpose();
  }
  return out;
}

}  // namespace

RowMatrixXf RunLifter(const LifterWeights& weights, const RowMatrixXf& features) {
  BODYLOOM_CHECK(features.cols() == weights.num_inputs(), "lifter: ", features.cols(),
                 " features a frame for a network of ", weights.num_inputs());
  RowMatrixXf h = Convolve(features, weights.input, weights.input_bias, 1);
  for (const LifterWeights::Block& block : weights.blocks) {
    RowMatrixXf inner = Convolve(NormaliseFrames(h, block.norm_scale, block.norm_shift), block.dilated,
                                 block.dilated_bias, block.dilation);
    inner = inner.array() / (1 + (-inner.array()).exp());  // SiLU
    h.rowwise() += block.mix_bias.transpose();
    h.noalias() += inner * block.mix.transpose();
  }
  RowMatrixXf out = NormaliseFrames(h, weights.norm_scale, weights.norm_shift) * weights.output.transpose();
  out.rowwise() += weights.output_bias.transpose();
  return out;
}

}  // namespace bodyloom
