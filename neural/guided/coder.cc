// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/guided/coder.h"

#include <algorithm>
#include <string>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

using torch::Tensor;

EncoderImpl::EncoderImpl(int in, const std::vector<int>& widths) {
  for (size_t l = 0; l < widths.size(); ++l) {
    blocks.push_back(register_module("block" + std::to_string(l), ConvBlock(l == 0 ? in : widths[l - 1], widths[l])));
  }
}

std::vector<Tensor> EncoderImpl::forward(Tensor x) {
  const int64_t multiple = int64_t{1} << blocks.size();
  BODYLOOM_CHECK(x.dim() == 4 && x.size(2) % multiple == 0 && x.size(3) % multiple == 0 &&
                     (x.size(2) / multiple) * (x.size(3) / multiple) >= 2,
                 "encoder: an input of shape ", x.sizes(), ", expected sides that are multiples of ", multiple,
                 " and two pixels at the deepest level");
  std::vector<Tensor> features;
  for (ConvBlock& block : blocks) {
    x = block(x);
    features.push_back(x);
  }
  return features;
}

SkipDecoderImpl::SkipDecoderImpl(int code, const std::vector<int>& widths, int input, int out) {
  const int levels = static_cast<int>(widths.size());
  int channels = code;
  for (int l = levels - 1; l >= 0; --l) {
    const int to = widths[std::max(l - 1, 0)];
    const int from = l == levels - 1 ? channels : channels + widths[l];
    blocks.push_back(register_module("block" + std::to_string(l), DeconvBlock(from, widths[l], to)));
    channels = to;
  }
  std::reverse(blocks.begin(), blocks.end());
  head = register_module("head", MakeConv(channels + input, out, 3, 1, 1, /*bias=*/true));
  torch::nn::init::normal_(head->weight, 0, 0.02);
}

Tensor SkipDecoderImpl::forward(Tensor code, const Tensor& input, const std::vector<Tensor>& features) {
  const int levels = static_cast<int>(blocks.size());
  Tensor x = std::move(code);
  for (int l = levels - 1; l >= 0; --l) x = blocks[l](l == levels - 1 ? x : torch::cat({x, features[l]}, 1));
  return head(torch::cat({x, input}, 1));
}

Tensor Cropped(const Tensor& map, const CodeBox& box) {
  return map.slice(2, box.y, box.y + box.height).slice(3, box.x, box.x + box.width);
}

}  // namespace bodyloom
