// SPDX-License-Identifier: Apache-2.0
#include "tracking/lifter/lifter_network.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "tracking/lifter/matrix_simd.h"

namespace bodyloom {
namespace {

constexpr float kNormEpsilon = 1e-5F;  // LibTorch's LayerNorm

/// Frames per strip, such that their rows and the weights' stay in the second-level cache.
constexpr Eigen::Index kStrip = 96;

/// out(r) += W x(r) for `rows` rows of as many values as W has columns.
void AddProduct(const float* x, Eigen::Index rows, const RowMatrixXf& weight, float* out) {
  matrix_internal::AddTimesTransposed(x, weight.cols(), static_cast<int>(rows), weight.data(), weight.cols(),
                                      static_cast<int>(weight.rows()), static_cast<int>(weight.cols()), out,
                                      weight.rows());
}

using Rows = std::vector<int>;

/// `rows` and those a step before and after each, within the clip; ascending.
Rows Around(const Rows& rows, int dilation, int num_frames) {
  std::vector<char> wanted(num_frames, 0);
  for (const int t : rows) {
    for (const int u : {t - dilation, t, t + dilation}) {
      if (u >= 0 && u < num_frames) wanted[u] = 1;
    }
  }
  Rows around;
  for (int t = 0; t < num_frames; ++t) {
    if (wanted[t]) around.push_back(t);
  }
  return around;
}

/// out(t) = bias + Σ_k W_k x(t + (k − 1) dilation), k = 0, 1, 2, for the rows t that are requested; x is zero outside.
/// `place[t]` is the row of x that holds frame t.
RowMatrixXf Convolve(const RowMatrixXf& x, const std::vector<int>& place, const Rows& rows, const RowMatrixXf& weight,
                     const Eigen::VectorXf& bias, int dilation) {
  const Eigen::Index C = x.cols();
  const auto count = static_cast<Eigen::Index>(rows.size());
  RowMatrixXf out = bias.transpose().replicate(count, 1);
  RowMatrixXf taps(std::min(kStrip, count), 3 * C);
  for (Eigen::Index begin = 0; begin < count; begin += kStrip) {
    const Eigen::Index strip = std::min(kStrip, count - begin);
    taps.setZero();
    for (Eigen::Index i = 0; i < strip; ++i) {
      for (int k = 0; k < 3; ++k) {
        const int t = rows[begin + i] + (k - 1) * dilation;
        if (t < 0 || t >= static_cast<int>(place.size())) continue;
        taps.row(i).segment(k * C, C) = x.row(place[t]);
      }
    }
    AddProduct(taps.data(), strip, weight, out.row(begin).data());
  }
  return out;
}

/// Row of each frame in a matrix that holds `rows`; −1: none.
std::vector<int> PlacesOf(const Rows& rows, int num_frames) {
  std::vector<int> place(num_frames, -1);
  for (size_t i = 0; i < rows.size(); ++i) place[rows[i]] = static_cast<int>(i);
  return place;
}

/// Normalises each row to mean 0 and variance 1, then applies scale and shift.
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

RowMatrixXf RunLifter(const LifterWeights& weights, const RowMatrixXf& features, int last_frames) {
  BODYLOOM_CHECK(features.cols() == weights.num_inputs(), "lifter: ", features.cols(),
                 " features a frame for a network of ", weights.num_inputs());
  const int T = static_cast<int>(features.rows());
  // Rows that each layer needs, from the output back.
  std::vector<Rows> needed(weights.blocks.size() + 1);
  for (int t = last_frames > 0 ? std::max(0, T - last_frames) : 0; t < T; ++t) needed.back().push_back(t);
  for (size_t b = weights.blocks.size(); b-- > 0;) needed[b] = Around(needed[b + 1], weights.blocks[b].dilation, T);
  Rows all(T);
  std::iota(all.begin(), all.end(), 0);
  RowMatrixXf h = Convolve(features, all, needed[0], weights.input, weights.input_bias, 1);
  for (size_t b = 0; b < weights.blocks.size(); ++b) {
    const LifterWeights::Block& block = weights.blocks[b];
    const std::vector<int> place = PlacesOf(needed[b], T);
    RowMatrixXf inner = Convolve(NormaliseFrames(h, block.norm_scale, block.norm_shift), place, needed[b + 1],
                                 block.dilated, block.dilated_bias, block.dilation);
    inner = inner.array() / (1 + (-inner.array()).exp());  // SiLU
    RowMatrixXf next(static_cast<Eigen::Index>(needed[b + 1].size()), h.cols());
    for (size_t i = 0; i < needed[b + 1].size(); ++i) {
      next.row(static_cast<Eigen::Index>(i)) = h.row(place[needed[b + 1][i]]) + block.mix_bias.transpose();
    }
    AddProduct(inner.data(), inner.rows(), block.mix, next.data());
    h = std::move(next);
  }
  RowMatrixXf out = weights.output_bias.transpose().replicate(h.rows(), 1);
  const RowMatrixXf last = NormaliseFrames(h, weights.norm_scale, weights.norm_shift);
  AddProduct(last.data(), last.rows(), weights.output, out.data());
  return out;
}

}  // namespace bodyloom
