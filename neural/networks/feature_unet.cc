// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/networks/feature_unet.h"

#include <string>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/networks/blocks.h"

namespace bodyloom {

using torch::Tensor;

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
