// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/guided_networks.h"

#include <algorithm>
#include <string>

#include "geometry/base/check.h"
#include "render/texture/photo_frame.h"

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

GarNetImpl::GarNetImpl(const GuidedConfig& config) {
  const std::vector<int>& widths = config.profile.shape_widths;
  const int input = 4 + config.LabelChannels();
  encoder = register_module("encoder", Encoder(input, widths));
  decoder = register_module("decoder", SkipDecoder(2 * widths.back(), widths, input, kPhotoLabels));
  if (!config.profile.one_hot_labels) return;
  // Initialised to return the labels of its input; label 0 stands for unknown ones.
  const torch::NoGradGuard no_grad;
  const int64_t first_label = decoder->head->weight.size(1) - kPhotoLabels;
  for (int64_t k = 1; k < kPhotoLabels; ++k) decoder->head->weight[k][first_label + k][1][1] += 4;
}

torch::Tensor GarNetImpl::EncodeSource(const torch::Tensor& triplet) { return encoder(triplet).back(); }

torch::Tensor GarNetImpl::forward(const torch::Tensor& source_code, const torch::Tensor& triplet) {
  const std::vector<torch::Tensor> features = encoder(triplet);
  return decoder(torch::cat({features.back(), source_code}, 1), triplet, features);
}

SilNetImpl::SilNetImpl(const GuidedConfig& config) {
  const std::vector<int>& widths = config.profile.shape_widths;
  from_body = config.profile.start_from_body;
  const int input = 3 + (config.profile.contour_hints ? config.LabelChannels() + 2 : 0) + (from_body ? 1 : 0);
  source_encoder = register_module("source_encoder", Encoder(4 + config.LabelChannels(), widths));
  target_encoder = register_module("target_encoder", Encoder(input, widths));
  decoder = register_module("decoder", SkipDecoder(2 * widths.back(), widths, input, 1));
  if (!from_body) return;
  // Initialised to logits of 4 inside and −2 outside of the predicted clothed silhouette, or, without one, of the bare
  // body widened by a pixel and softened.
  const torch::NoGradGuard no_grad;
  Tensor weight = decoder->head->weight[0];
  const int64_t channels = weight.size(0);
  if (config.profile.contour_hints && config.source_silhouette) {
    weight[channels - 2][1][1] += 6;
  } else {
    weight[channels - 1] += 6.0 / 9;
  }
  decoder->head->bias -= 2;
}

Tensor SilNetImpl::EncodeSource(const Tensor& triplet) { return source_encoder(triplet).back(); }

Tensor SilNetImpl::forward(const Tensor& source_code, const Tensor& pose, const Tensor& seen) {
  std::vector<Tensor> inputs = {pose};
  if (seen.defined()) inputs.push_back(seen);
  if (from_body) inputs.push_back((pose.amax(1, /*keepdim=*/true) > 0).to(pose.scalar_type()));
  const Tensor input = torch::cat(inputs, 1);
  const std::vector<Tensor> features = target_encoder(input);
  return decoder(torch::cat({features.back(), source_code}, 1), input, features);
}

namespace nn = torch::nn;

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
  // Initialised to return the known colours: sigmoid(4 (x − ½)) is near x.
  const torch::NoGradGuard no_grad;
  for (int64_t c = 0; c < 3; ++c) last->weight[c][p.full_width + c][1][1] += 4;
  last->bias.slice(0, 0, 3).fill_(-2);
}

RenderCode RenderNetImpl::EncodeSource(const Tensor& triplet) {
  if (!config.latent) return {};
  const Tensor deepest = source_encoder(triplet).back();
  if (config.kl) {
    const std::vector<Tensor> parts = code_head(deepest).chunk(2, 1);
    // Clamped against overflow; values beyond e^±10 make no difference.
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
