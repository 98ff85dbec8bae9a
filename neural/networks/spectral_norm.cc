// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/networks/spectral_norm.h"

#include "bodyloom/neural/networks/blocks.h"

namespace bodyloom {

using torch::Tensor;

namespace {

constexpr double kTinyNorm = 1e-12;
constexpr int kFirstIterations = 8;  ///< so that a network starts near its true scale

Tensor Normalized(const Tensor& x) { return x / (x.norm() + kTinyNorm); }

}  // namespace

Tensor SpectralScale(const Tensor& weight, const Tensor& u, const Tensor& v) {
  return torch::dot(u, torch::mv(weight.flatten(1), v));
}

SpectralConvImpl::SpectralConvImpl(int from, int to, int kernel, bool bias, bool normalise)
    : conv(register_module("conv", MakeConv(from, to, kernel, 1, kernel / 2, bias))) {
  if (!normalise) return;
  u = register_buffer("u", Normalized(torch::randn({to})));
  v = register_buffer("v", torch::zeros({int64_t{from} * kernel * kernel}));
  for (int i = 0; i < kFirstIterations; ++i) Iterate();
}

void SpectralConvImpl::Iterate() {
  const torch::NoGradGuard no_grad;
  const Tensor matrix = conv->weight.flatten(1);
  // New tensors, not in place: a backward pass may still hold the old ones.
  v.set_data(Normalized(torch::mv(matrix.t(), u)));
  u.set_data(Normalized(torch::mv(matrix, v)));
}

Tensor SpectralConvImpl::forward(const Tensor& x) {
  if (!u.defined()) return conv(x);
  if (is_training()) Iterate();
  const Tensor weight = conv->weight / SpectralScale(conv->weight, u.detach(), v.detach());
  return torch::conv2d(x, weight, conv->bias, 1, conv->weight.size(2) / 2);
}

}  // namespace bodyloom
