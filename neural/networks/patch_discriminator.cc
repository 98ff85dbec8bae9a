// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/patch_discriminator.h"

#include <algorithm>
#include <string>

#include "geometry/base/check.h"
#include "neural/networks/blocks.h"

namespace bodyloom {

PatchDiscriminatorImpl::PatchDiscriminatorImpl(const PatchDiscriminatorOptions& discriminator_options)
    : options(discriminator_options) {
  BODYLOOM_CHECK(options.in > 0 && options.ndf > 0 && options.n_layers >= 1 && options.n_layers <= 8 &&
                     (options.padding == 1 || options.padding == 2),
                 "discriminator: ", options.in, " input channels, ndf ", options.ndf, ", ", options.n_layers,
                 " layers, padding ", options.padding, ", expected in and ndf > 0, 1 to 8 layers, padding 1 or 2");
  const auto add = [&](int from, int to, int stride, bool bias) {
    layers.push_back(
        register_module("conv" + std::to_string(layers.size()), MakeConv(from, to, 4, stride, options.padding, bias)));
    torch::nn::init::normal_(layers.back()->weight, 0, 0.02);
  };
  int channels = options.ndf;
  add(options.in, channels, 2, true);
  for (int n = 1; n <= options.n_layers; ++n) {
    const int next = std::min(2 * channels, 8 * options.ndf);
    add(channels, next, n < options.n_layers ? 2 : 1, false);
    channels = next;
  }
  add(channels, 1, 1, true);
}

torch::Tensor PatchDiscriminatorImpl::forward(torch::Tensor x) {
  BODYLOOM_CHECK(x.dim() == 4 && x.size(1) == options.in, "discriminator: an input of shape ", x.sizes(),
                 ", expected B x ", options.in, " x H x W");
  const int64_t smallest = std::min(x.size(2), x.size(3));
  const int64_t needed = int64_t{4} << options.n_layers;
  BODYLOOM_CHECK(smallest >= needed, "discriminator: an input of ", x.size(2), " x ", x.size(3),
                 " pixels, expected at least ", needed, " a side for ", options.n_layers, " layers");
  x = LeakyRelu(layers.front()(x));
  for (size_t i = 1; i + 1 < layers.size(); ++i) {
    x = NormAndActivation(layers[i](x), NormOrder::kNormFirst);
  }
  return layers.back()(x);
}

MultiScaleDiscriminatorImpl::MultiScaleDiscriminatorImpl(const PatchDiscriminatorOptions& options, int num_scales) {
  BODYLOOM_CHECK(num_scales >= 1, "discriminator: ", num_scales, " scales, expected 1 or more");
  for (int s = 0; s < num_scales; ++s) {
    scales.push_back(register_module("scale" + std::to_string(s), PatchDiscriminator(options)));
  }
}

std::vector<torch::Tensor> MultiScaleDiscriminatorImpl::forward(torch::Tensor x) {
  std::vector<torch::Tensor> logits;
  for (size_t s = 0; s < scales.size(); ++s) {
    if (s > 0) x = torch::avg_pool2d(x, 3, 2, 1, /*ceil_mode=*/false, /*count_include_pad=*/false);
    logits.push_back(scales[s](x));
  }
  return logits;
}

}  // namespace bodyloom
