// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/motion_model.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "geometry/base/check.h"
#include "neural/networks/uv_sampler.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr int kUvChannels = 3;  // u, v, 1
constexpr double kTinyLength = 1e-6;

/// Normalises vectors; nearly zero ones stay short.
Tensor Unit(const Tensor& x) { return x / (x.square().sum(1, true) + kTinyLength).sqrt(); }

}  // namespace

std::vector<Tensor*> MotionState::Parts() {
  std::vector<Tensor*> parts;
  for (Tensor* part : {&labels, &image, &normals}) {
    if (part->defined()) parts.push_back(part);
  }
  return parts;
}

MotionModelImpl::MotionModelImpl(const MotionConfig& model_config) : config(model_config) {
  std::string why;
  BODYLOOM_CHECK(config.IsValid(&why), "motion renderer: ", why);
  const MotionProfile& p = config.profile;
  const int projected = (config.motion ? p.features : 0) + (!config.motion || config.surface ? kUvChannels : 0) +
                        (config.texture ? p.texture_features : 0);
  if (config.texture) {
    texture = register_module("texture",
                              LearnedTexture(p.texture_size, p.texture_features, config.shape ? config.num_labels : 0));
  }
  if (config.motion) {
    encoder = register_module("encoder", UNet(UNetOptions{config.motion_channels, {p.features}, p.encoder_widths}));
  }
  if (config.shape) {
    shape_decoder = register_module(
        "shape_decoder", UNet(UNetOptions{projected + config.num_labels, {config.num_labels}, p.decoder_widths}));
  }
  const int past = 3 + (config.normals ? 3 : 0);
  std::vector<int> heads = {3};
  if (config.normals) heads.push_back(3);
  appearance_decoder = register_module(
      "appearance_decoder",
      UNet(UNetOptions{projected + (config.shape ? config.num_labels : 0) + past, heads, p.decoder_widths}));
}

Tensor MotionModelImpl::Encode(const Tensor& motion) {
  BODYLOOM_CHECK(config.motion, "motion renderer: there is no encoder in a network without motion");
  return encoder(motion)[0];
}

Tensor MotionModelImpl::Project(const Tensor& descriptor, const Tensor& uv, const Tensor& body) {
  std::vector<Tensor> parts;
  const bool in_uv = config.descriptor == MotionDescriptor::kSurface;
  if (config.motion) parts.push_back(in_uv ? SampleUv(descriptor, uv, body) : descriptor);
  if (!config.motion || config.surface) parts.insert(parts.end(), {uv * body, body});
  if (config.texture) parts.push_back(texture(uv, body));
  return torch::cat(parts, 1);
}

MotionStepResult MotionModelImpl::Decode(const Tensor& projected, const MotionState& before) {
  MotionStepResult result;
  std::vector<Tensor> input = {projected};
  const Tensor texel =
      config.texture ? projected.slice(1, projected.size(1) - config.profile.texture_features) : Tensor();
  if (config.shape) {
    result.label_logits = shape_decoder(torch::cat({projected, before.labels}, 1))[0];
    if (config.texture) result.label_logits = result.label_logits + texture->labels_of_texel(texel);
    result.state.labels = torch::softmax(result.label_logits, 1);
    result.foreground = 1 - result.state.labels.slice(1, 0, 1);
    input.push_back(result.state.labels);
  } else {
    result.foreground = torch::ones({projected.size(0), 1, projected.size(2), projected.size(3)}, projected.options());
  }
  input.push_back(before.image);
  if (config.normals) input.push_back(before.normals);
  const std::vector<Tensor> heads = appearance_decoder(torch::cat(input, 1));
  const Tensor colour = config.texture ? heads[0] + texture->colour_of_texel(texel) : heads[0];
  result.colour = torch::sigmoid(colour);
  result.state.image = result.foreground * result.colour;
  if (config.normals) result.state.normals = result.foreground * Unit(torch::tanh(heads[1]));
  return result;
}

MotionStepResult MotionModelImpl::forward(const MotionInput& input, const MotionState& before) {
  const Tensor descriptor = config.motion ? Encode(input.motion) : Tensor();
  return Decode(Project(descriptor, input.uv, input.body), before);
}

MotionState MotionModelImpl::InitialState(int64_t batch, int64_t height, int64_t width) const {
  MotionState state;
  const auto options = appearance_decoder->parameters().front().options().requires_grad(false);
  const auto zeros = [&](int64_t channels) { return torch::zeros({batch, channels, height, width}, options); };
  if (config.shape) state.labels = zeros(config.num_labels);
  state.image = zeros(3);
  if (config.normals) state.normals = zeros(3);
  return state;
}

namespace {

/// Gain of the learned texture: Adam changes a texel by its rate per step, and most texels are seen in few steps.
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
