// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/blocks.h"

#include <array>
#include <cmath>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace nn = torch::nn;

double KaimingStd(double fan_in) { return std::sqrt(2 / ((1 + kLeakySlope * kLeakySlope) * fan_in)); }

}  // namespace

// In place: neither a convolution nor the norm reads its own output in the backward pass.
torch::Tensor LeakyRelu(torch::Tensor x) { return torch::leaky_relu_(x, kLeakySlope); }

torch::Tensor InstanceNorm(const torch::Tensor& x) {
  return torch::instance_norm(x, {}, {}, {}, {}, /*use_input_stats=*/true, /*momentum=*/0.1, /*eps=*/1e-5,
                              /*cudnn_enabled=*/true);
}

torch::Tensor NormAndActivation(const torch::Tensor& x, NormOrder order) {
  return order == NormOrder::kNormFirst ? LeakyRelu(InstanceNorm(x)) : InstanceNorm(LeakyRelu(x));
}

torch::Tensor NormAndRelu(const torch::Tensor& x) {
  torch::Tensor y = InstanceNorm(x);
  return torch::relu_(y);
}

nn::Conv2d MakeConv(int from, int to, int kernel, int stride, int padding, bool bias) {
  BODYLOOM_CHECK(from > 0 && to > 0, "convolution: ", from, " to ", to, " channels, expected 1 or more");
  nn::Conv2d conv(nn::Conv2dOptions(from, to, kernel).stride(stride).padding(padding).bias(bias));
  nn::init::normal_(conv->weight, 0, KaimingStd(static_cast<double>(from) * kernel * kernel));
  if (bias) nn::init::zeros_(conv->bias);
  return conv;
}

ConvBlockImpl::ConvBlockImpl(int ic, int oc, NormOrder norm_order) : order(norm_order) {
  const bool bias = order == NormOrder::kActivationFirst;
  conv1 = register_module("conv1", MakeConv(ic, oc, 3, 1, 1, bias));
  conv2 = register_module("conv2", MakeConv(oc, oc, 3, 1, 1, bias));
  down = register_module("down", MakeConv(oc, oc, 4, 2, 1, bias));
}

torch::Tensor ConvBlockImpl::forward(torch::Tensor x) {
  x = NormAndActivation(conv1(x), order);
  x = NormAndActivation(conv2(x), order);
  return NormAndActivation(down(x), order);
}

DeconvBlockImpl::DeconvBlockImpl(int ic, int mc, int oc, NormOrder norm_order) : order(norm_order) {
  const bool bias = order == NormOrder::kActivationFirst;
  BODYLOOM_CHECK(oc > 0, "D-BLK: ", oc, " channels, expected 1 or more");
  conv1 = register_module("conv1", MakeConv(ic, mc, 3, 1, 1, bias));
  conv2 = register_module("conv2", MakeConv(mc, mc, 3, 1, 1, bias));
  conv3 = register_module("conv3", MakeConv(mc, mc, 3, 1, 1, bias));
  up = register_module("up", nn::ConvTranspose2d(nn::ConvTranspose2dOptions(mc, oc, 4).stride(2).padding(1)));
  nn::init::normal_(up->weight, 0, KaimingStd(4.0 * mc));  // a quarter of the 16 taps contributes to each output pixel
  nn::init::zeros_(up->bias);
}

torch::Tensor DeconvBlockImpl::forward(torch::Tensor x) {
  x = NormAndActivation(conv1(x), order);
  x = NormAndActivation(conv2(x), order);
  x = NormAndActivation(conv3(x), order);
  return LeakyRelu(TransposedConv(x, up->weight, up->bias, 1, 0));
}

namespace {

using torch::Tensor;
using torch::indexing::Slice;

/// Rows (or columns) of the kernel used by outputs of one parity, for inputs from `first` (relative to half the
/// output's index) upwards.
struct Taps {
  int first = 0;
  std::vector<int64_t> kernel;
};

Taps TapsOf(int parity, int kernel, int padding) {
  Taps taps;
  // o = 2i − p + k: the larger k, the smaller i.
  for (int k = kernel - 1; k >= 0; --k) {
    if ((parity + padding - k) % 2 != 0) continue;
    if (taps.kernel.empty()) taps.first = (parity + padding - k) / 2;
    taps.kernel.push_back(k);
  }
  return taps;
}

}  // namespace

Tensor TransposedConv(const Tensor& x, const Tensor& weight, const Tensor& bias, int padding, int output_padding) {
  const auto kernel = static_cast<int>(weight.size(2));
  BODYLOOM_CHECK(
      padding == 1 && kernel + output_padding == 4 && (kernel == 4 || kernel == 3) && weight.size(3) == kernel,
      "transposed convolution: kernel ", kernel, ", padding ", padding, ", output padding ", output_padding);
  if (!x.device().is_cpu()) return torch::conv_transpose2d(x, weight, bias, 2, padding, output_padding);
  const int64_t batch = x.size(0), height = x.size(2), width = x.size(3);
  const Tensor by_output = weight.transpose(0, 1);
  const Tensor padded = torch::constant_pad_nd(x, {1, 1, 1, 1});
  std::array<Taps, 2> taps = {TapsOf(0, kernel, padding), TapsOf(1, kernel, padding)};
  const auto share = [](const Tensor& all, int64_t dimension, const Taps& of) {
    // Every other row, in reverse order.
    std::vector<Tensor> rows;
    for (const int64_t k : of.kernel) rows.push_back(all.select(dimension, k));
    return torch::stack(rows, dimension);
  };
  const auto reach = [](int64_t size, const Taps& of) {
    const auto begin = int64_t{1} + of.first;
    return Slice(begin, begin + size + static_cast<int64_t>(of.kernel.size()) - 1);
  };
  std::vector<Tensor> parities;
  for (const Taps& rows : taps) {
    const Tensor kernel_rows = share(by_output, 2, rows);
    for (const Taps& columns : taps) {
      const Tensor seen = padded.index({Slice(), Slice(), reach(height, rows), reach(width, columns)});
      parities.push_back(torch::conv2d(seen, share(kernel_rows, 3, columns), bias));
    }
  }
  const Tensor stacked = torch::stack(parities, 2);  // B × oc × 4 × H × W
  return torch::pixel_shuffle(stacked.reshape({batch, 4 * stacked.size(1), height, width}), 2);
}

}  // namespace bodyloom
