// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/networks/blocks.h"

#include <cmath>

#include "bodyloom/geometry/base/check.h"

#include "bodyloom/neural/networks/transposed_conv.h"

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
  nn::init::normal_(up->weight, 0, KaimingStd(4.0 * mc));  // a quarter of the 16 taps meets each output pixel
  nn::init::zeros_(up->bias);
}

torch::Tensor DeconvBlockImpl::forward(torch::Tensor x) {
  x = NormAndActivation(conv1(x), order);
  x = NormAndActivation(conv2(x), order);
  x = NormAndActivation(conv3(x), order);
  return LeakyRelu(TransposedConv(x, up->weight, up->bias, 1, 0));
}

}  // namespace bodyloom
