// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/networks/residual_generator.h"

#include <string>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/networks/blocks.h"
#include "bodyloom/neural/networks/transposed_conv.h"

namespace bodyloom {

using torch::Tensor;
namespace nn = torch::nn;

namespace {

constexpr int kGeneratorLevels = 3;

template <class Convolution>
Convolution Initialised(Convolution conv) {
  nn::init::normal_(conv->weight, 0, 0.02);
  nn::init::zeros_(conv->bias);
  return conv;
}

nn::Conv2d Conv(int from, int to, int kernel, int stride, int padding) {
  return Initialised(MakeConv(from, to, kernel, stride, padding, /*bias=*/true));
}

Tensor Reflected(const Tensor& x, int64_t by) { return torch::reflection_pad2d(x, {by, by, by, by}); }

}  // namespace

ResidualGeneratorImpl::ResidualGeneratorImpl(const ResidualGeneratorOptions& generator_options)
    : options(generator_options) {
  BODYLOOM_CHECK(options.in > 0 && options.out > 0 && options.width > 0 && options.blocks >= 0,
                 "generator: ", options.in, " to ", options.out, " channels, width ", options.width, ", ",
                 options.blocks, " blocks, expected positive numbers");
  BODYLOOM_CHECK(options.up_kernel == 3 || options.up_kernel == 4, "generator: kernels of ", options.up_kernel,
                 " on the way up, expected 3 or 4");
  int channels = options.width;
  first = register_module("first", Conv(options.in, channels, 7, 1, 0));
  for (int i = 0; i < kGeneratorLevels; ++i, channels *= 2) {
    down.push_back(register_module("down" + std::to_string(i), Conv(channels, 2 * channels, 3, 2, 1)));
  }
  for (int i = 0; i < options.blocks; ++i) {
    for (const char* half : {"a", "b"}) {
      blocks.push_back(register_module("block" + std::to_string(i) + half, Conv(channels, channels, 3, 1, 0)));
    }
  }
  for (int i = 0; i < kGeneratorLevels; ++i, channels /= 2) {
    up.push_back(register_module(
        "up" + std::to_string(i),
        Initialised(nn::ConvTranspose2d(nn::ConvTranspose2dOptions(channels, channels / 2, options.up_kernel)
                                            .stride(2)
                                            .padding(1)
                                            .output_padding(4 - options.up_kernel)))));
  }
  last = register_module("last", Conv(channels + options.passed, options.out, 7, 1, 0));
}

Tensor ResidualGeneratorImpl::forward(Tensor x, const Tensor& passed) {
  BODYLOOM_CHECK(x.dim() == 4 && x.size(1) == options.in && x.size(2) % kResidualGeneratorMultiple == 0 &&
                     x.size(3) % kResidualGeneratorMultiple == 0 && x.size(2) >= 16 && x.size(3) >= 16,
                 "generator: an input of shape ", x.sizes(), ", expected B x ", options.in,
                 " x H x W, sides multiples of 8 and at least 16");
  BODYLOOM_CHECK(options.passed == 0 ? !passed.defined()
                                     : passed.defined() && passed.dim() == 4 && passed.size(0) == x.size(0) &&
                                           passed.size(1) == options.passed && passed.size(2) == x.size(2) &&
                                           passed.size(3) == x.size(3),
                 "generator: what is passed by an input of shape ", x.sizes(), ", expected ", options.passed,
                 " channels of its size");
  x = NormAndRelu(first(Reflected(x, 3)));
  for (nn::Conv2d& conv : down) x = NormAndRelu(conv(x));
  for (size_t i = 0; i < blocks.size(); i += 2) {
    const Tensor inner = NormAndRelu(blocks[i](Reflected(x, 1)));
    x = x + InstanceNorm(blocks[i + 1](Reflected(inner, 1)));
  }
  for (nn::ConvTranspose2d& conv : up) {
    x = NormAndRelu(TransposedConv(x, conv->weight, conv->bias, 1, 4 - options.up_kernel));
  }
  return last(Reflected(options.passed > 0 ? torch::cat({x, passed}, 1) : x, 3));
}

}  // namespace bodyloom
