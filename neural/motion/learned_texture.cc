// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/motion/learned_texture.h"

#include "bodyloom/neural/networks/uv_sampler.h"

namespace bodyloom {
namespace {

/// Adam moves a texel by its rate a step, and most texels are seen in few of them.
constexpr double kGain = 10;

}  // namespace

LearnedTextureImpl::LearnedTextureImpl(int size, int features, int num_labels) {
  const auto matrix = [&](int rows) {
    return torch::nn::Conv2d(torch::nn::Conv2dOptions(features, rows, 1).bias(false));
  };
  values = register_parameter("values", torch::zeros({1, features, size, size}));
  colour_of_texel = register_module("colour_of_texel", matrix(3));
  if (num_labels > 0) labels_of_texel = register_module("labels_of_texel", matrix(num_labels));
}

torch::Tensor LearnedTextureImpl::forward(const torch::Tensor& uv, const torch::Tensor& body) {
  return SampleUv(kGain * values.expand({uv.size(0), -1, -1, -1}), uv, body);
}

}  // namespace bodyloom
