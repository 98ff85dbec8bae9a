// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/photo_renderer.h"

#include <span>

#include "geometry/base/check.h"
#include "neural/base/device.h"
#include "neural/photo/photo_model.h"
#include "neural/training/checkpoint.h"

namespace bodyloom {

class PhotoRenderer::Impl {
 public:
  Impl(const std::string& path, const PhotoConfig& config, const PhotoRendererOptions& options)
      : reach_(options.reach), model_(LoadModel<PhotoModel>(path, config, options.num_threads, options.device)) {}

  void Encode(const PartialTexture& texture) {
    const int U = model_->config.profile.texture_size;
    BODYLOOM_CHECK(texture.size == U, "photo renderer: a texture of ", texture.size, " texels a side, expected ", U);
    const torch::NoGradGuard no_grad;
    features_ = model_->Complete(ToTensors(std::span(&texture, 1)));
  }

  [[nodiscard]] RenderedPerson Render(const PhotoFrame& pose) const {
    CheckEncoded();
    const int S = model_->config.profile.image_size;
    BODYLOOM_CHECK(pose.size == S, "photo renderer: a frame of ", pose.size, " pixels a side, expected ", S);
    return RenderPhoto(model_, features_, pose, reach_);
  }

  [[nodiscard]] std::vector<float> CompletedTexture() const {
    CheckEncoded();
    return HostValues<float>((0.5 * (features_.slice(1, 0, 3) + 1)).clamp(0, 1));
  }

 private:
  void CheckEncoded() const { BODYLOOM_CHECK(features_.defined(), "photo renderer: no texture encoded yet"); }

  int reach_;
  PhotoModel model_;
  torch::Tensor features_;
};

PhotoRenderer::PhotoRenderer(const std::string& checkpoint_path, const PhotoConfig& config,
                             const PhotoRendererOptions& options)
    : impl_(std::make_unique<Impl>(checkpoint_path, config, options)) {}
PhotoRenderer::~PhotoRenderer() = default;

void PhotoRenderer::Encode(const PartialTexture& texture) { impl_->Encode(texture); }
RenderedPerson PhotoRenderer::Render(const PhotoFrame& pose) const { return impl_->Render(pose); }
std::vector<float> PhotoRenderer::CompletedTexture() const { return impl_->CompletedTexture(); }

}  // namespace bodyloom
