// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/photo_model.h"

#include <algorithm>
#include <span>
#include <vector>

#include "geometry/base/check.h"
#include "neural/base/device.h"
#include "neural/networks/uv_sampler.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr int kFillLevels = 5;  ///< reaches about 32 pixels outwards

/// Initialises the first three outputs to the input's colours, the others near 0. `colours`: index of the first of
/// these among the convolution's inputs.
void StartFromColours(torch::nn::Conv2dImpl* last, int colours) {
  const torch::NoGradGuard no_grad;
  torch::nn::init::normal_(last->weight, 0, 0.02);
  const int64_t centre = last->weight.size(2) / 2;
  for (int c = 0; c < 3; ++c) last->weight[c][colours + c][centre][centre] += 1;
}

/// Initialises alpha to the body widened by a pixel or two and softened, for clothes: 4 inside, −2 outside, and in
/// between by the share of the kernel on the body.
void StartFromBody(torch::nn::Conv2dImpl* last, int body) {
  const torch::NoGradGuard no_grad;
  last->weight[3][body] += 6.0 / static_cast<double>(last->weight[3][body].numel());
  last->bias[3] -= 2;
}

}  // namespace

PhotoModelImpl::PhotoModelImpl(const PhotoConfig& model_config) : config(model_config) {
  std::string why;
  BODYLOOM_CHECK(config.IsValid(&why), "photo renderer: ", why);
  const PhotoProfile& p = config.profile;
  if (config.Completes()) {
    feature_net =
        register_module("feature_net", FeatureUNet(FeatureUNetOptions{4, config.TextureChannels(), p.feature_widths}));
    StartFromColours(feature_net->last.get(), p.feature_widths[0]);
  }
  render_net = register_module("render_net", ResidualGenerator(ResidualGeneratorOptions{
                                                 config.RenderChannels(), 4, p.render_width, p.render_blocks,
                                                 config.PassedChannels(), p.render_up_kernel}));
  if (p.render_passes_input) {
    StartFromColours(render_net->last.get(), p.render_width);
    StartFromBody(render_net->last.get(), p.render_width + config.PassedChannels() - 1);
  }
}

Tensor PhotoModelImpl::Complete(const TextureTensors& texture) {
  if (!config.Completes()) return texture.colour;
  BODYLOOM_CHECK(texture.guess.defined() == config.GuessesUnseen(), "photo renderer: a texture ",
                 config.GuessesUnseen() ? "without" : "with", " guesses at what is not seen");
  const Tensor colour = config.GuessesUnseen() ? texture.colour + texture.guess : texture.colour;
  return feature_net(torch::cat({colour, texture.visible}, 1));
}

Tensor PhotoModelImpl::Project(const Tensor& features, const PoseTensors& pose) const {
  Tensor projected = SampleUv(features, pose.uv, pose.body);
  if (config.variant != PhotoVariant::kWarpCond) return projected;
  return torch::cat({projected, pose.uv * pose.body, pose.parts}, 1);
}

PhotoResult PhotoModelImpl::Render(const Tensor& projected, const Tensor& body) {
  Tensor passed;
  // Colours must be first, for StartFromColours().
  if (config.profile.render_passes_input) {
    passed = torch::cat({PullPush(projected.slice(1, 0, 3), body, kFillLevels), projected, body}, 1);
  }
  const Tensor raw = render_net(projected, passed);
  PhotoResult result;
  result.alpha_logit = raw.slice(1, 3, 4);
  result.alpha = torch::sigmoid(result.alpha_logit);
  result.image = result.alpha * (0.5 * (torch::tanh(raw.slice(1, 0, 3)) + 1));
  return result;
}

PhotoResult PhotoModelImpl::forward(const TextureTensors& texture, const PoseTensors& pose) {
  return Render(Project(Complete(texture), pose), pose.body);
}

MultiScaleDiscriminator PhotoDiscriminator(const PhotoConfig& config) {
  const PhotoProfile& p = config.profile;
  return MultiScaleDiscriminator(
      PatchDiscriminatorOptions{config.RenderChannels() + 3, p.discriminator_width, p.discriminator_layers, 2},
      p.discriminator_scales);
}

RenderedPerson RenderPhoto(PhotoModel model, const torch::Tensor& features, const PhotoFrame& pose, int reach) {
  const torch::NoGradGuard no_grad;
  const int S = pose.size;
  const size_t pixels = static_cast<size_t>(S) * S;
  RenderedPerson rendered;
  rendered.size = S;
  rendered.image.assign(3 * pixels, 0);
  rendered.alpha.assign(pixels, 0);
  if (std::all_of(pose.parts.begin(), pose.parts.end(), [](uint8_t part) { return part == 0; })) return rendered;
  const PhotoWindow window =
      reach < 0 ? PhotoWindow{0, 0, S, S} : WindowAround(pose, reach, model->config.SmallestSide());
  const PoseTensors seen = PoseOf(std::span(&pose, 1), std::span(&window, 1));
  const PhotoResult result = model->Render(model->Project(features, seen), seen.body);
  const auto paste = [&](const torch::Tensor& tensor, std::vector<float>* planar) {
    const std::vector<float> whole = HostValues<float>(tensor);
    auto from = whole.begin();
    for (int64_t c = 0; c < tensor.size(1); ++c) {
      for (int y = 0; y < window.height; ++y, from += window.width) {
        std::copy_n(from, window.width, planar->begin() + ((c * S + window.y + y) * S + window.x));
      }
    }
  };
  paste(result.image, &rendered.image);
  paste(result.alpha, &rendered.alpha);
  return rendered;
}

}  // namespace bodyloom
