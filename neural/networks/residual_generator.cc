// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/residual_generator.h"

#include <string>

#include "geometry/base/check.h"
#include "neural/networks/blocks.h"

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

namespace {

Tensor Twice(Tensor x, torch::nn::Conv2d* convolutions) {
  for (int i = 0; i < 2; ++i) x = NormAndRelu(convolutions[i](x));
  return x;
}

}  // namespace

FeatureUNetImpl::FeatureUNetImpl(const FeatureUNetOptions& unet_options) : options(unet_options) {
  BODYLOOM_CHECK(options.in > 0 && options.out > 0 && options.widths.size() >= 2, "feature U-Net: ", options.in, " to ",
                 options.out, " channels, ", options.widths.size(), " widths, expected two or more");
  const auto add = [&](const std::string& name, int from, int to, std::vector<torch::nn::Conv2d>* side) {
    side->push_back(register_module(name + "a", MakeConv(from, to, 3, 1, 1, false)));
    side->push_back(register_module(name + "b", MakeConv(to, to, 3, 1, 1, false)));
  };
  const std::vector<int>& w = options.widths;
  for (size_t l = 0; l < w.size(); ++l) {
    add("encoder" + std::to_string(l), l == 0 ? options.in : w[l - 1], w[l], &encoder);
  }
  for (size_t l = 0; l + 1 < w.size(); ++l) add("decoder" + std::to_string(l), w[l + 1] + w[l], w[l], &decoder);
  last = register_module("last", MakeConv(w[0] + options.in, options.out, 3, 1, 1, true));
}

Tensor FeatureUNetImpl::forward(Tensor x) {
  const int64_t multiple = int64_t{1} << (options.widths.size() - 1);
  BODYLOOM_CHECK(x.dim() == 4 && x.size(1) == options.in && x.size(2) % multiple == 0 && x.size(3) % multiple == 0 &&
                     x.size(2) >= 2 * multiple && x.size(3) >= 2 * multiple,
                 "feature U-Net: an input of shape ", x.sizes(), ", expected B x ", options.in,
                 " x H x W, sides multiples of ", multiple, " and at least ", 2 * multiple);
  const Tensor input = x;
  std::vector<Tensor> passed;
  const size_t levels = options.widths.size() - 1;
  for (size_t l = 0; l <= levels; ++l) {
    if (l > 0) x = torch::max_pool2d(x, 2);
    x = Twice(x, &encoder[2 * l]);
    if (l < levels) passed.push_back(x);
  }
  for (size_t l = levels; l-- > 0;) {
    x = torch::upsample_bilinear2d(x, {2 * x.size(2), 2 * x.size(3)}, /*align_corners=*/false);
    x = Twice(torch::cat({x, passed[l]}, 1), &decoder[2 * l]);
  }
  return last(torch::cat({x, input}, 1));
}

}  // namespace bodyloom
