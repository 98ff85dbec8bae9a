// SPDX-License-Identifier: Apache-2.0
#include "neural/networks/unet.h"

#include <algorithm>
#include <string>

#include "geometry/base/check.h"

namespace bodyloom {

UNetImpl::UNetImpl(const UNetOptions& unet_options) : options(unet_options) {
  const auto positive = [](const std::vector<int>& values) {
    return !values.empty() && *std::min_element(values.begin(), values.end()) > 0;
  };
  BODYLOOM_CHECK(options.in > 0 && positive(options.out) && positive(options.widths) && options.widths.size() <= 16,
                 "U-Net: ", options.in, " input channels, ", options.out.size(), " heads, ", options.widths.size(),
                 " levels, expected one or more of each (levels: 16 at most) and positive channels");
  const int levels = static_cast<int>(options.widths.size());
  const auto decoder_width = [&](int level) { return std::max(options.widths[level], options.decoder_min); };
  int channels = options.in;
  for (int l = 0; l < levels; ++l) {
    encoder.push_back(
        register_module("encoder" + std::to_string(l), ConvBlock(channels, options.widths[l], options.norm_order)));
    channels = options.widths[l];
  }
  for (int l = levels - 1; l >= 0; --l) {
    const int from = l == levels - 1 ? channels : channels + options.widths[l];
    channels = decoder_width(std::max(l - 1, 0));
    decoder.push_back(register_module("decoder" + std::to_string(l),
                                      DeconvBlock(from, decoder_width(l), channels, options.norm_order)));
  }
  std::reverse(decoder.begin(), decoder.end());
  for (size_t h = 0; h < options.out.size(); ++h) {
    heads.push_back(
        register_module("head" + std::to_string(h), MakeConv(channels, options.out[h], 3, 1, 1, /*bias=*/true)));
    torch::nn::init::normal_(heads.back()->weight, 0, 0.02);
  }
}

std::vector<torch::Tensor> UNetImpl::forward(torch::Tensor x) {
  const int levels = static_cast<int>(encoder.size());
  BODYLOOM_CHECK(x.dim() == 4 && x.size(1) == options.in, "U-Net: an input of shape ", x.sizes(), ", expected B x ",
                 options.in, " x H x W");
  const int64_t multiple = int64_t{1} << levels, height = x.size(2), width = x.size(3);
  BODYLOOM_CHECK(height > 0 && width > 0 && height % multiple == 0 && width % multiple == 0 &&
                     (height / multiple) * (width / multiple) >= 2,
                 "U-Net: an input of ", height, " x ", width, " pixels, expected multiples of ", multiple, " for ",
                 levels, " levels and at least two pixels at the deepest");
  std::vector<torch::Tensor> skips;
  for (ConvBlock& block : encoder) {
    x = block(x);
    skips.push_back(x);
  }
  for (int l = levels - 1; l >= 0; --l) {
    x = decoder[l](l == levels - 1 ? x : torch::cat({x, skips[l]}, 1));
  }
  std::vector<torch::Tensor> outputs;
  for (torch::nn::Conv2d& head : heads) outputs.push_back(head(x));
  return outputs;
}

}  // namespace bodyloom
