// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/guided/render_net.h"

#include <algorithm>
#include <string>

namespace bodyloom {

namespace nn = torch::nn;
using torch::Tensor;

Tensor Draw(const RenderCode& code, const Tensor& noise) {
  if (!noise.defined() || !code.log_variance.defined()) return code.mean;
  return code.mean + torch::exp(0.5 * code.log_variance) * noise;
}

RenderNetImpl::RenderNetImpl(const GuidedConfig& guided_config) : config(guided_config) {
  const GuidedProfile& p = config.profile;
  const int labels = config.LabelChannels(), levels = config.Levels();
  if (config.latent) {
    source_encoder = register_module("source_encoder", Encoder(4 + labels, p.encoder_widths));
    if (config.kl) {
      code_head = register_module("code_head", MakeConv(p.encoder_widths.back(), 2 * p.latent, 3, 1, 1, true));
      nn::init::normal_(code_head->weight, 0, 0.02);
    } else {
      flat1 = register_module("flat1", nn::Linear(p.encoder_widths.back(), p.latent));
      flat2 = register_module("flat2", nn::Linear(p.latent, p.latent));
    }
  }
  const int guide = labels + 1 + (config.PoseForRender() ? 3 : 0), pseudo = 4;
  guide_encoder = register_module("guide_encoder", Encoder(guide, p.encoder_widths));
  pseudo_encoder = register_module("pseudo_encoder", Encoder(pseudo, p.encoder_widths));
  first = register_module("first", MakeConv(p.latent, p.decoder_widths.back(), 3, 1, 1, true));
  int channels = p.decoder_widths.back();
  for (int l = levels - 1; l >= 0; --l) {
    const int to = p.decoder_widths[l], hidden = std::min(p.modulation_width, to);
    blocks.push_back(register_module(
        "block" + std::to_string(l),
        ModulatedBlock(channels, to, std::vector<int>(2, p.encoder_widths[l]), hidden, p.spectral_norm)));
    channels = to;
  }
  std::reverse(blocks.begin(), blocks.end());
  full = register_module("full", ModulatedBlock(channels, p.full_width, std::vector<int>{guide, pseudo},
                                                std::min(p.modulation_width, p.full_width), p.spectral_norm));
  const int out = config.silhouettes || config.garments ? 3 : 4;
  last = register_module("last", MakeConv(p.full_width + pseudo, out, 3, 1, 1, true));
  nn::init::normal_(last->weight, 0, 0.02);
  // A new network shows what is known: sigmoid(4 (x − ½)) is near x.
  const torch::NoGradGuard no_grad;
  for (int64_t c = 0; c < 3; ++c) last->weight[c][p.full_width + c][1][1] += 4;
  last->bias.slice(0, 0, 3).fill_(-2);
}

RenderCode RenderNetImpl::EncodeSource(const Tensor& triplet) {
  if (!config.latent) return {};
  const Tensor deepest = source_encoder(triplet).back();
  if (config.kl) {
    const std::vector<Tensor> parts = code_head(deepest).chunk(2, 1);
    // Beyond e^±10 nothing changes but the danger of overflow.
    return {parts[0], parts[1].clamp(-20, 20)};
  }
  const Tensor code = flat2(torch::relu(flat1(deepest.mean({2, 3}))));
  return {code.unsqueeze(2).unsqueeze(3).expand({-1, -1, deepest.size(2), deepest.size(3)}), {}};
}

Tensor RenderNetImpl::forward(const Tensor& code, const Tensor& guide, const Tensor& pseudo, const Tensor& shown) {
  const std::vector<Tensor> guide_features = guide_encoder(guide), pseudo_features = pseudo_encoder(pseudo);
  const Tensor& deepest = guide_features.back();
  const Tensor z =
      code.defined()
          ? code
          : torch::zeros({guide.size(0), config.profile.latent, deepest.size(2), deepest.size(3)}, guide.options());
  Tensor x = first(z);
  for (int l = config.Levels() - 1; l >= 0; --l) {
    x = blocks[l]->forward(x, {guide_features[l], pseudo_features[l]});
    x = torch::upsample_nearest2d(x, {2 * x.size(2), 2 * x.size(3)});
  }
  x = full->forward(x, {guide, pseudo});
  return last(torch::cat({LeakyRelu(x), shown, pseudo.slice(1, 3, 4)}, 1));
}

}  // namespace bodyloom
